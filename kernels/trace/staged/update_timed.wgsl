// A further pass changes only the colour of a pixel.

fn resume(index: u32) {}

fn update(index: u32, rgba: u32) {
    pixels[index].rgba = rgba;
}

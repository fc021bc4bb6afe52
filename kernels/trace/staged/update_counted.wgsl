// A further pass changes the colour of a pixel, and goes on counting where the pass before it ended.

fn resume(index: u32) {
    counters = pixels[index].counters;
}

fn update(index: u32, rgba: u32) {
    pixels[index].rgba = rgba;
    pixels[index].counters = counters;
}

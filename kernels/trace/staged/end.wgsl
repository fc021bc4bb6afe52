// The last pass: no path goes on.

fn append(pixel: u32, path: Path) {}

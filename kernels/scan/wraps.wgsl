// 1 once an addition of this frame has wrapped round; the pass that writes the total takes it and leaves 0.
@group(0) @binding(4) var<storage, read_write> wrapped: atomic<u32>;

fn note_wrap() {
    atomicStore(&wrapped, 1u);
}

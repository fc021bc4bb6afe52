//! Every renderer on the CPU makes the reference's bits, whatever its width, level, switches and threads.

use super::support::{self, Scene, frame, switches, view};
use rtbench::workloads::spheres::options::{Algorithm, Options, Renderer};
use rtbench::workloads::spheres::render::compare::compare;
use rtbench::workloads::spheres::render::reference::{self, Reference};
use rtbench::workloads::spheres::view::View;

const ALGORITHMS: [Algorithm; 2] = [Algorithm::TwoPass, Algorithm::OnePass];

/// Panics where pictures, hits or counts of a renderer are not the reference's.
fn same(renderer: Renderer, options: Options, scene: &Scene, view: &View, reference: &Reference) {
    let frame = frame(renderer, options, None, &scene.spheres, view);
    let width = view.width as usize;
    let what = format!("{renderer:?} {options:?} at {} x {}", view.width, view.height);
    assert_eq!(compare(&frame.timed, &reference.image, width), None, "{what}");
    assert_eq!(compare(&frame.counted, &reference.image, width), None, "counted, {what}");
    assert_eq!(frame.hits, reference.hits, "{what}");
    assert_eq!(frame.counts.rays, reference.counts.rays, "{what}");
    assert_eq!(frame.counts.hits, reference.counts.hits, "{what}");
}

#[test]
fn all_renderers_make_the_same_bits_with_all_switches() {
    let scene = support::random(20, 7);
    for (width, height) in [(1, 1), (7, 5), (64, 36)] {
        let view = view(&scene, width, height, 5);
        for algorithm in ALGORITHMS {
            let reference = reference::render(&scene.spheres, &view, algorithm);
            for options in switches(algorithm, false) {
                same(Renderer::Sequential, options, &scene, &view, &reference);
            }
            for renderer in support::simd() {
                for options in switches(algorithm, true) {
                    same(renderer, options, &scene, &view, &reference);
                }
            }
        }
    }
}

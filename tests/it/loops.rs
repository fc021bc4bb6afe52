//! Forms of the loops of bvh-stack, and ways through its tree without a stack: what is visited by each.

use crate::support::{gpu, soup};
use crate::traversal::{SIZE, counted, shiny};
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{Backend, Config, CountedPixel, Counters};

/// Sums of all ray types.
fn sums(pixels: &[CountedPixel]) -> [u64; 8] {
    let of = |get: fn(&Counters) -> u32| -> u64 {
        pixels.iter().flat_map(|pixel| &pixel.counters).map(|counters| u64::from(get(counters))).sum()
    };
    [
        of(|c| c.rays),
        of(|c| c.inner),
        of(|c| c.leaves),
        of(|c| c.tests),
        of(|c| c.boxes),
        of(|c| c.pops),
        of(|c| c.restarts),
        of(|c| c.ropes),
    ]
}

fn on_each_backend(check: impl Fn(&dyn Backend)) {
    check(&CpuBackend::new(2).unwrap());
    if let Some(gpu) = gpu() {
        check(gpu);
    }
}

/// If-if does the same in the same order, ray by ray.
#[test]
fn if_if_visits_what_while_while_visits() {
    let scene = shiny(soup(400, 31, false));
    on_each_backend(|backend| {
        for config in [Config::PSR, Config::DIFFUSE] {
            for cull in ["on", "off"] {
                let plain = counted(backend, &scene, &format!("bvh-stack:cull={cull}"), config, SIZE);
                let other = counted(backend, &scene, &format!("bvh-stack:cull={cull},loop=if-if"), config, SIZE);
                assert_eq!(plain, other, "{config:?} cull={cull} on {}", backend.info().backend);
            }
        }
    });
}

/// A postponed leaf costs visits that its hit would have spared, and spares none. Without culling the nearest hit has
/// no effect on what is visited.
#[test]
fn a_postponed_leaf_only_adds_visits() {
    let scene = shiny(soup(400, 32, false));
    on_each_backend(|backend| {
        let of = |name: &str| counted(backend, &scene, name, Config::PS, SIZE).0;
        let (plain, speculative) = (of("bvh-stack"), of("bvh-stack:loop=speculative"));
        let visits = |pixel: &CountedPixel| {
            let Counters { inner, leaves, tests, .. } = pixel.counters[0];
            [inner, leaves, tests]
        };
        for (a, b) in plain.iter().zip(&speculative) {
            assert_eq!((a.pixel, a.t), (b.pixel, b.t));
            assert!(visits(a).iter().zip(visits(b)).all(|(a, b)| *a <= b), "{a:?} {b:?}");
        }
        assert!(sums(&speculative)[1] > sums(&plain)[1], "no leaf was postponed in vain: the test sees nothing");
        let primary = |name: &str| counted(backend, &scene, name, Config::P, SIZE).0;
        assert_eq!(primary("bvh-stack:cull=off"), primary("bvh-stack:cull=off,loop=speculative"));
    });
}

/// The trail begins at the root each time, and may visit a subtree again of which a hit has culled the sibling. Links
/// lead back over every inner node once.
#[test]
fn ways_without_a_stack_count_what_they_do_instead() {
    let scene = shiny(soup(400, 33, false));
    on_each_backend(|backend| {
        let of = |name: &str| sums(&counted(backend, &scene, name, Config::P, SIZE).0);
        let [rays, inner, leaves, tests, boxes, pops, restarts, ropes] = of("bvh-stack");
        assert!(pops > 0 && restarts == 0 && ropes == 0 && boxes == 2 * inner);
        let trail = of("bvh-stackless:search=trail");
        assert!(trail[0] == rays && trail[2] >= leaves && trail[3] >= tests, "{trail:?}");
        assert!(trail[1] > inner && trail[4] == 2 * trail[1] && trail[5] == 0 && trail[7] == 0, "{trail:?}");
        assert!(trail[6] > 0, "{trail:?}");
        let parent = of("bvh-stackless");
        assert!(parent[0] == rays && parent[5] == 0 && parent[6] == 0, "{parent:?}");
        // Both children of an inner node are tested one after the other
        assert_eq!([parent[4], parent[7]], [2 * parent[1], parent[1]]);
    });
}

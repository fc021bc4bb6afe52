//! throw-away
use glam::Vec3;
use rtbench::accel::*;
use rtbench::backend::*;
use rtbench::camera::*;
use rtbench::cpu::CpuBackend;
use rtbench::gpu::*;
use rtbench::math::*;
use rtbench::scene::*;
use std::time::Instant;
fn bunny() -> Scene {
    let p = std::env::args().nth(1).unwrap_or("/work/shared/scenes/bunny/bun_zipper.ply".into());
    let text = std::fs::read_to_string(p).unwrap();
    let mut lines = text.lines();
    let (mut nv, mut nf) = (0usize, 0usize);
    loop {
        let l = lines.next().unwrap();
        if let Some(n) = l.strip_prefix("element vertex ") {
            nv = n.trim().parse().unwrap()
        }
        if let Some(n) = l.strip_prefix("element face ") {
            nf = n.trim().parse().unwrap()
        }
        if l == "end_header" {
            break;
        }
    }
    let mut s = Scene { name: "bunny".into(), ..Default::default() };
    for _ in 0..nv {
        let v: Vec<f32> = lines.next().unwrap().split_whitespace().take(3).map(|x| x.parse().unwrap()).collect();
        s.vertices.push(Vertex::new(Vec3::new(v[0], v[1], v[2]), Vec3::ZERO))
    }
    for _ in 0..nf {
        let v: Vec<u32> = lines.next().unwrap().split_whitespace().map(|x| x.parse().unwrap()).collect();
        s.triangles.push(Triangle { vertices: [v[1], v[2], v[3]], material: 0 })
    }
    for t in &s.triangles {
        let [a, b, c] = t.vertices.map(|i| s.vertices[i as usize].position);
        let n = (b - a).cross(c - a);
        for i in t.vertices {
            s.vertices[i as usize].normal += n;
        }
    }
    for v in &mut s.vertices {
        v.normal = v.normal.normalize_or_zero();
    }
    s.materials.push(Material::matt(Vec3::new(0.6, 0.5, 0.4)).shiny(Vec3::splat(0.3), 20.0, 0.3));
    s.background = Vec3::splat(0.2);
    s
}
fn main() {
    let s = bunny();
    let b = s.bounds();
    let dir = Vec3::new(0.3, -0.2, -1.0).normalize();
    let view = View {
        camera: Camera {
            position: b.center() - dir * b.diagonal() * 0.9,
            direction: dir,
            up: Vec3::Y,
            field_of_view: 45.0,
        },
        lights: vec![
            Light::new(b.center() + Vec3::new(1., 2., 3.) * b.diagonal(), Vec3::splat(0.8)),
            Light::new(b.center() + Vec3::new(-1., 2., 1.) * b.diagonal(), Vec3::splat(0.3)),
        ],
    };
    let t = Instant::now();
    let bvh = bvh_build::build(&s, &Default::default()).unwrap();
    println!("build {:?} nodes {} depth {}", t.elapsed(), bvh.nodes.len(), bvh.depth);
    let st = Structure::Bvh(bvh);
    let cpu = CpuBackend::new(0).unwrap();
    let gpu = GpuBackend::open(&Selector::Best, GpuOptions::default()).unwrap();
    let size = Size { width: 200, height: 136 };
    for tr in [Traversal::BvhStack] {
        let mut c = cpu.prepare(&s, &st, tr).unwrap();
        let mut g = gpu.prepare(&s, &st, tr).unwrap();
        for config in [Config::P, Config::PS] {
            let mut a = Vec::new();
            c.counted(config, &view, size, &mut |_, p| a.extend_from_slice(p)).unwrap();
            let mut d = Vec::new();
            g.counted(config, &view, size, &mut |_, p| d.extend_from_slice(p)).unwrap();
            let hits = a.iter().zip(&d).filter(|(x, y)| x.pixel.triangle != y.pixel.triangle || x.t != y.t).count();
            let counters = a.iter().zip(&d).filter(|(x, y)| x.counters != y.counters).count();
            let colours = a.iter().zip(&d).filter(|(x, y)| x.pixel.rgba != y.pixel.rgba).count();
            let im = g.image(config, &view, size).unwrap();
            let same = im.iter().zip(&d).filter(|(x, y)| **x != y.pixel).count();
            let im = c.image(config, &view, size).unwrap();
            let same2 = im.iter().zip(&a).filter(|(x, y)| **x != y.pixel).count();
            let mut sum = [[0u64; 6]; 3];
            for p in &a {
                for k in 0..3 {
                    let c = p.counters[k];
                    for (i, v) in [c.rays, c.inner, c.leaves, c.tests, c.pops, c.restarts].into_iter().enumerate() {
                        sum[k][i] += v as u64
                    }
                }
            }
            println!(
                "{tr:?} {config:?}: hits {hits} counters {counters} colours {colours} timed!=counted gpu {same} cpu {same2} sums {sum:?}"
            );
        }
    }
    // obvhs
    let tris: Vec<obvhs::triangle::Triangle> = (0..s.triangles.len() as u32)
        .map(|i| {
            let [a, b, c] = s.corners(i);
            obvhs::triangle::Triangle { v0: a, v1: b, v2: c }
        })
        .collect();
    let ob = obvhs::bvh2::builder::build_bvh2_from_tris(
        &tris,
        obvhs::BvhBuildParams::medium_build(),
        &mut Default::default(),
    );
    let rt: Vec<obvhs::rt_triangle::RtTriangle> =
        ob.primitive_indices.iter().map(|i| (&tris[*i as usize]).into()).collect();
    use rayon::prelude::*;
    let n = 1024u32;
    let grid = view.camera.pixel_grid(n, n);
    let size = Size { width: n, height: n };
    let views = vec![view.clone(); 1];
    let mut c = cpu.prepare(&s, &st, Traversal::BvhStack).unwrap();
    let mut g = gpu.prepare(&s, &st, Traversal::BvhStack).unwrap();
    let cpu_now = || {
        let s = std::fs::read_to_string("/proc/self/stat").unwrap();
        let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
        f[11].parse::<f64>().unwrap() * 10.0 + f[12].parse::<f64>().unwrap() * 10.0
    };
    let mut cpus = [0.0f64; 3];
    let mut times = [vec![], vec![], vec![]];
    for _ in 0..7 {
        let t = Instant::now();
        let c0 = cpu_now();
        let _hits: usize = (0..n * n / 64)
            .into_par_iter()
            .map(|g| {
                let mut hits = 0;
                let (gx, gy) = (g % (n / 8) * 8, g / (n / 8) * 8);
                for l in 0..64 {
                    let (x, y) = (gx + l % 8, gy + l / 8);
                    let d = (grid.corner + grid.right * (x as f32 + 0.5) + grid.down * (y as f32 + 0.5)).normalize();
                    let ray = obvhs::ray::Ray::new_inf(grid.origin.into(), d.into());
                    let mut hit = obvhs::ray::RayHit::none();
                    if ob.ray_traverse(ray, &mut hit, |ray, id| rt[id].intersect(ray)) {
                        hits += 1
                    }
                }
                hits
            })
            .sum();
        times[0].push(t.elapsed().as_secs_f64() * 1e3);
        let c1 = cpu_now();
        cpus[0] += c1 - c0;
        times[1].push(c.time_path(Config::P, &views, size, &|| false).unwrap()[0].wall_ns as f64 * 1e-6);
        let c2 = cpu_now();
        cpus[1] += c2 - c1;
        times[2].push(g.time_path(Config::P, &views, size, &|| false).unwrap()[0].device_ns.unwrap() as f64 * 1e-6);
        cpus[2] += cpu_now() - c2;
    }
    println!("cpu time {cpus:?} ratio cpu/obvhs {:.3} gpu/obvhs {:.3}", cpus[0] / cpus[1], cpus[0] / cpus[2]);
    for (name, t) in ["obvhs", "cpu", "gpu"].iter().zip(&mut times) {
        t.sort_by(f64::total_cmp);
        println!("{name}: median {:.1} ms min {:.1} -> {:.2} Mrays/s", t[3], t[0], (n * n) as f64 / t[3] * 1e-3);
    }
    println!("ratio cpu/obvhs {:.3} gpu/obvhs {:.3}", times[0][3] / times[1][3], times[0][3] / times[2][3]);
}

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
    let dirs: Vec<String> = std::env::args().skip(2).collect();
    let gpus: Vec<GpuBackend> =
        dirs.iter().map(|_| GpuBackend::open(&Selector::Best, GpuOptions::default()).unwrap()).collect();
    let mut gs: Vec<_> = gpus.iter().map(|g| g.prepare(&s, &st, Traversal::BvhStack).unwrap()).collect();
    let n = 1024;
    let size = Size { width: n, height: n };
    let views = vec![view.clone(); 1];
    let mut reference = None;
    for (d, g) in dirs.iter().zip(&mut gs) {
        #[allow(unsafe_code)]
        unsafe {
            std::env::set_var("KDIR", d)
        };
        let im = g.image(Config::P, &view, size).unwrap();
        let r = reference.get_or_insert_with(|| im.clone());
        println!("{d}: {} pixels differ", im.iter().zip(r.iter()).filter(|(a, b)| a != b).count());
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
    let mut c = cpu.prepare(&s, &st, Traversal::BvhStack).unwrap();
    let mut times = vec![vec![]; dirs.len() + 2];
    for _ in 0..15 {
        let t = Instant::now();
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
        times[1].push(c.time_path(Config::P, &views, size, &|| false).unwrap()[0].wall_ns as f64 * 1e-6);
        for (i, g) in gs.iter_mut().enumerate() {
            times[2 + i]
                .push(g.time_path(Config::P, &views, size, &|| false).unwrap()[0].device_ns.unwrap() as f64 * 1e-6);
        }
    }
    for t in &mut times {
        t.sort_by(f64::total_cmp);
    }
    let (m0, med0) = (times[0][0], times[0][7]);
    for (name, t) in ["obvhs", "cpu"].into_iter().map(String::from).chain(dirs.iter().cloned()).zip(&times) {
        println!("{name:12}: min {:.1} ms ratio {:.3}; median {:.1} ratio {:.3}", t[0], m0 / t[0], t[7], med0 / t[7]);
    }
}

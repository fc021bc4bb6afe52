//! throw-away
use glam::Vec3;
use rtbench::accel::*;
use rtbench::math::*;
use rtbench::scene::*;
fn main() {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _) = tobj::load_obj("/work/shared/scenes/sponza/sponza.obj", &options).unwrap();
    let mut scene = Scene { name: "obj".into(), materials: vec![Material::matt(Vec3::ONE)], ..Scene::default() };
    for mesh in models.iter().map(|model| &model.mesh) {
        let first = scene.vertices.len() as u32;
        scene.vertices.extend(mesh.positions.chunks_exact(3).map(|p| Vertex::new(Vec3::from_slice(p), Vec3::ZERO)));
        scene.triangles.extend(
            mesh.indices
                .chunks_exact(3)
                .map(|i| Triangle { vertices: [first + i[0], first + i[1], first + i[2]], material: 0 }),
        );
    }
    for opt in ["kdtree", "kdtree:exact_below=1000000000", "kdtree:exact_below=1"] {
        let b = Selection::parse(opt).unwrap().build(&scene, 1).unwrap();
        println!("{opt} validate {:?}", b.structure.validate(&scene));
        let Structure::KdTree(k) = &b.structure else { panic!() };
        println!("{:?}", b.structure.properties(&scene));
        println!("tri {:?} bounds {:?}", scene.corners(15777), k.bounds);
        // leaves holding 15777
        fn walk(k: &kdtree::KdTree, n: u32, b: Aabb, depth: u32, out: &mut Vec<(u32, Aabb)>) {
            let node = k.nodes[n as usize];
            if node.is_leaf() {
                if k.records[node.first() as usize..][..node.count() as usize].iter().any(|r| r.triangle == 15777) {
                    out.push((n, b))
                }
                return;
            }
            let (mut l, mut r) = (b, b);
            l.max[node.axis()] = node.split();
            r.min[node.axis()] = node.split();
            walk(k, n + 1, l, depth + 1, out);
            walk(k, node.right(), r, depth + 1, out);
        }
        let mut out = vec![];
        walk(k, 0, k.bounds, 0, &mut out);
        println!("leaves {} {:?}", out.len(), &out[..out.len().min(3)]);
        let p =
            Vec3::new(-19.754213, 42.25478, -11.0797615) + Vec3::new(0.68910664, -0.6907552, 0.21906467) * 38.510704;
        println!("hit point {p:?}");
        for (n, b) in &out {
            if (0..3).all(|a| p[a] >= b.min[a] - 1e-3 && p[a] <= b.max[a] + 1e-3) {
                println!("contains: {n} {b:?}")
            }
        }
        // leaf at the point
        let (mut n, mut b) = (0u32, k.bounds);
        loop {
            let node = k.nodes[n as usize];
            if node.is_leaf() {
                println!("leaf at point {n} {b:?} count {}", node.count());
                break;
            }
            let a = node.axis();
            if p[a] < node.split() {
                b.max[a] = node.split();
                n += 1
            } else {
                b.min[a] = node.split();
                n = node.right()
            }
        }
    }
}

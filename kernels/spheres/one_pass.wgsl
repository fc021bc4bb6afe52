// Colours on the way, scaled by what the surfaces so far reflect.

//!include spheres/search.wgsl

fn follow(first: Ray) -> Path {
    var ray = first;
    var hit = no_hit();
    var path = Path(real3(0.0), 0u, 0u);
    var share = real3(real(band.view.one));
    var live = true;
    for (var trip = 0u; trip < TRIPS; trip += 1u) {
        let found = search(ray, &hit);
        path.searches += 1u;
        live = live && found;
        if (EXIT_ON_MISS && !live) {
            break;
        }
        if (live) {
            path.color += share * lighting(ray.direction, hit);
            share *= hit.color * real(band.view.intensity);
            path.hits += 1u;
        }
        ray = reflected(ray, hit);
    }
    return path;
}

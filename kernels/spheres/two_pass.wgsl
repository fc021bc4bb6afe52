// All rays and hits of a path into arrays, then colours from the last one to the first.

//!include spheres/search.wgsl

fn follow(first: Ray) -> Path {
    var rays: array<Ray, TRIPS>;
    var hits: array<Hit, TRIPS>;
    var ray = first;
    var hit = no_hit();
    var path = Path(real3(0.0), 0u, 0u);
    var live = true;
    for (var trip = 0u; trip < TRIPS; trip += 1u) {
        let found = search(ray, &hit);
        path.searches += 1u;
        live = live && found;
        if (EXIT_ON_MISS && !live) {
            break;
        }
        rays[trip] = ray;
        hits[trip] = hit;
        path.hits += select(0u, 1u, live);
        ray = reflected(ray, hit);
    }
    // A path is live until its first miss: the live hits are the first ones
    for (var trip = path.hits; trip > 0u; trip -= 1u) {
        let at = hits[trip - 1u];
        path.color = ((path.color * real(band.view.intensity)) * at.color) + lighting(rays[trip - 1u].direction, at);
    }
    return path;
}

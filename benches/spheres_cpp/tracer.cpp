// The scalar one-pass tracer in C++, as one writes it down: what the program's own scalar renderer is compared with.
//
// Standard input: uint32 rounds, width, height, trips, spheres; the view's 27 floats in the order of `View` below; then
// eight floats a sphere. Standard output: the picture as four floats a pixel. Standard error: the milliseconds of each
// round, one a line.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

struct Vec3 {
    float x, y, z;
};

static Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
static Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
static Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
static float dot(Vec3 a, Vec3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
static Vec3 normalize(Vec3 a) { return a / std::sqrt(dot(a, a)); }

struct View {
    Vec3 origin;
    float epsilon;
    Vec3 corner;
    float intensity;
    Vec3 right;
    float half;
    Vec3 down;
    float one;
    Vec3 light;
    float two;
    Vec3 light_color;
    float far;
    Vec3 ambient;
};

struct Sphere {
    Vec3 center;
    float radius2;
    Vec3 color;
    float pad;
};

struct Hit {
    Vec3 position, normal, color;
};

static bool search(const std::vector<Sphere>& spheres, const View& view, Vec3 origin, Vec3 d, Hit& hit) {
    const float a = dot(d, d);
    float best = view.far;
    const Sphere* nearest = nullptr;
    for (const Sphere& sphere : spheres) {
        const Vec3 oc = sphere.center - origin;
        const float b = dot(oc, d);
        const float q = dot(oc, oc) - sphere.radius2;
        const float discriminant = b * b - a * q;
        if (discriminant > 0.0f) {
            const float root = std::sqrt(discriminant);
            float t = (b - root) / a;
            if (!(t > view.epsilon)) t = (b + root) / a;
            if (t > view.epsilon && t < best) {
                best = t;
                nearest = &sphere;
            }
        }
    }
    if (!nearest) return false;
    hit.position = origin + d * best;
    hit.normal = normalize(hit.position - nearest->center);
    hit.color = nearest->color;
    return true;
}

static Vec3 lighting(const View& view, Vec3 d, const Hit& hit) {
    const float nl = dot(hit.normal, view.light);
    const bool lit = nl > 0.0f;
    const float diffuse = lit ? nl : 0.0f;
    const Vec3 mirrored = hit.normal * (view.two * nl) - view.light;
    const float rv = -dot(mirrored, d);
    float specular = lit && rv > 0.0f ? rv : 0.0f;
    for (int i = 0; i < 5; ++i) specular *= specular;
    return hit.color * (view.ambient + view.light_color * diffuse) + view.light_color * specular;
}

static void render(const std::vector<Sphere>& spheres, const View& view, uint32_t width, uint32_t height,
                   uint32_t trips, float* image) {
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            const float px = float(x) + view.half, py = float(y) + view.half;
            Vec3 d = normalize((view.corner + view.right * px) + view.down * py);
            Vec3 origin = view.origin;
            Vec3 color = {0.0f, 0.0f, 0.0f};
            Vec3 throughput = {view.one, view.one, view.one};
            Hit hit;
            for (uint32_t trip = 0; trip < trips; ++trip) {
                if (!search(spheres, view, origin, d, hit)) break;
                color = color + throughput * lighting(view, d, hit);
                throughput = throughput * (hit.color * view.intensity);
                d = normalize(d - hit.normal * (view.two * dot(d, hit.normal)));
                origin = hit.position;
            }
            float* pixel = image + (size_t(y) * width + x) * 4;
            pixel[0] = color.x;
            pixel[1] = color.y;
            pixel[2] = color.z;
            pixel[3] = 1.0f;
        }
    }
}

int main() {
    uint32_t n[5];
    View view;
    if (std::fread(n, sizeof n, 1, stdin) != 1) return 1;
    if (std::fread(&view, sizeof view, 1, stdin) != 1) return 1;
    std::vector<Sphere> spheres(n[4]);
    if (std::fread(spheres.data(), sizeof(Sphere), n[4], stdin) != n[4]) return 1;
    std::vector<float> image(size_t(n[1]) * n[2] * 4);
    for (uint32_t round = 0; round < n[0]; ++round) {
        const auto start = std::chrono::steady_clock::now();
        render(spheres, view, n[1], n[2], n[3], image.data());
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        std::fprintf(stderr, "%.6f\n", time.count());
    }
    return std::fwrite(image.data(), sizeof(float), image.size(), stdout) == image.size() ? 0 : 1;
}

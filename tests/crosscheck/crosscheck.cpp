// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/crosscheck.h>
#include <crosscheck/lit_points.h>
#include <crosscheck/vdb_irradiance.h>
#include <reference/reference_cache.h>
#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/ply.h>
#include <vmap/exporters/render_picture.h>
#include <vmap/exporters/vdb_grid.h>
#include <vmap/importers/sample_surface.h>
#include <vmap/light.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <optional>
#include <string>

namespace vmap::crosscheck {
namespace {

namespace fs = std::filesystem;
using Imath::C3f;
using std::numbers::pi;

/// Below it a channel of albedo tells too little about irradiance.
constexpr float smallest_albedo = 0.05F;

/// Pixels about an edge of a shadow that are left out.
constexpr int shadow_margin = 2;

LitCloud light_points(const Scene& scene, const CrosscheckConfig& config) {
    LitCloud lit;
    lit.points = sample_surface(scene, {.points = config.points, .spacing = std::nullopt});
    PointCloud reflecting = lit.points;
    // Black points reflect nothing: what is left is direct light.
    if (config.direct_only) std::fill(reflecting.albedo.begin(), reflecting.albedo.end(), C3f(0, 0, 0));
    lit.irradiance = compute_light(reflecting, scene.lights, {.tolerance = config.tolerance}).irradiance;
    return lit;
}

/// Irradiance of the cloud as its files have it, by way of the disk.
struct OurFiles {
    reference::LitPly ply;
    std::unique_ptr<VdbIrradiance> vdb;
};

OurFiles write_and_read(const LitCloud& cloud) {
    const fs::path stem = fs::temp_directory_path() / ("vmap_crosscheck_" + std::to_string(::getpid()));
    const OutputInfo info{.up = UpAxis::z, .source = "crosscheck"};
    FileWriter ply(stem.string() + ".ply", Durability::fast);
    write_ply(ply, cloud, info);
    ply.commit();
    FileWriter vdb(stem.string() + ".vdb", Durability::fast);
    write_vdb_grid(vdb, cloud, info);
    vdb.commit();
    OurFiles files{.ply = reference::read_lit_ply(ply.path()), .vdb = std::make_unique<VdbIrradiance>(vdb.path())};
    fs::remove(ply.path());
    fs::remove(vdb.path());
    return files;
}

bool only_sources_light(const Scene& scene) {
    return std::none_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.emits(); });
}

/// Pixels near the edge of a shadow or of a spot's cone.
std::vector<bool> near_shadow_edges(const Scene& scene, const SurfaceView& view) {
    std::vector<reference::ReferencePoint> points;
    points.reserve(view.pixels.size());
    for (const SurfacePixel& pixel : view.pixels) points.push_back(pixel.point);
    const auto direct = reference::trace_irradiance(scene, points, {.samples = 1, .max_bounces = 0});
    return near_difference(view, shadow_margin, [&](std::size_t a, std::size_t b) {
        return view.pixels[b].lit_side && (direct[a].irradiance.y > 0) != (direct[b].irradiance.y > 0);
    });
}

std::vector<std::size_t> pixels_to_compare(const Scene& scene, const SurfaceView& view) {
    std::vector<bool> edge(view.pixels.size(), false);
    if (only_sources_light(scene)) edge = near_shadow_edges(scene, view);
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
        const SurfacePixel& pixel = view.pixels[i];
        // A lamp that reflects nothing says nothing of irradiance.
        const bool lamp = pixel.emission != C3f(0, 0, 0) && pixel.albedo == C3f(0, 0, 0);
        if (pixel.lit_side && !pixel.border && !lamp && !edge[i]) pixels.push_back(i);
    }
    return pixels;
}

double mean_of(const C3f& color) {
    return (static_cast<double>(color.x) + color.y + color.z) / 3;
}

double difference_of(const C3f& a, const C3f& b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::abs(static_cast<double>(a[c]) - b[c]);
    return sum / 3;
}

/// Pairs of colours, as they come, and their figures in the end.
class Pairs {
public:
    void add(const C3f& result, const C3f& reference) {
        results_.push_back(mean_of(result));
        references_.push_back(mean_of(reference));
        differences_.push_back(difference_of(result, reference));
    }
    [[nodiscard]] DifferenceFigures figures() const { return difference_figures(differences_, results_, references_); }

private:
    std::vector<double> results_;
    std::vector<double> references_;
    std::vector<double> differences_;
};

/// What a picture says of irradiance at a pixel, where the albedo lets it tell.
std::optional<C3f> irradiance_of(const C3f& radiance, const SurfacePixel& pixel) {
    C3f result;
    for (int c = 0; c < 3; ++c) {
        if (pixel.albedo[c] < smallest_albedo) return std::nullopt;
        result[c] = static_cast<float>((radiance[c] - pixel.emission[c]) * pi / pixel.albedo[c]);
    }
    return result;
}

void compare_files(const OurFiles& files, Crosscheck& check) {
    const LitPoints points(files.ply);
    // Voxels are filled two beyond the surface, and interpolation reaches one further.
    const double reach = 3 * files.vdb->voxel_size();
    Pairs ply;
    Pairs vdb;
    for (const std::size_t i : check.pixels) {
        const SurfacePixel& pixel = check.view.pixels[i];
        const auto expected = irradiance_of(check.povray.picture.pixels[i], pixel);
        if (!expected) continue;
        const Imath::V3d& position = pixel.point.position;
        const Imath::V3d& normal = pixel.point.normal;
        if (const auto found = points.irradiance_at(position, normal)) ply.add(*found, *expected);
        if (points.is_alone(position, normal, reach)) vdb.add(files.vdb->at(position), *expected);
    }
    check.ply = ply.figures();
    check.vdb = vdb.figures();
}

/// Pixels at which the truth is traced.
std::vector<std::size_t> truth_pixels(const CrosscheckConfig& config, const Crosscheck& check) {
    std::vector<std::size_t> pixels;
    if (config.whole_truth) {
        for (std::size_t i = 0; i < check.view.pixels.size(); ++i)
            if (check.view.pixels[i].lit_side) pixels.push_back(i);
        return pixels;
    }
    const std::size_t step =
        std::max<std::size_t>(1, check.pixels.size() / std::max<std::size_t>(1, config.truth_pixels));
    for (std::size_t k = step / 2; k < check.pixels.size(); k += step) pixels.push_back(check.pixels[k]);
    return pixels;
}

void compare_with_truth(const Scene& scene, const CrosscheckConfig& config, Crosscheck& check) {
    const std::vector<std::size_t> pixels = truth_pixels(config, check);
    std::vector<reference::ReferencePoint> points;
    points.reserve(pixels.size());
    for (const std::size_t i : pixels) points.push_back(check.view.pixels[i].point);
    reference::ReferenceConfig traced{.samples = config.truth_samples};
    if (config.direct_only) traced.max_bounces = 0;
    const auto values = reference::cached_irradiance(config.cache, scene, points, traced);

    check.truth = {.width = config.width, .height = config.height, .pixels = {}, .alpha = {}};
    check.truth.pixels.resize(check.view.pixels.size(), C3f(0, 0, 0));
    std::vector<bool> compared(check.view.pixels.size(), false);
    for (const std::size_t i : check.pixels) compared[i] = true;
    Pairs ours;
    Pairs povray;
    double noise = 0;
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::size_t i = pixels[k];
        const C3f response = check.view.pixels[i].albedo / static_cast<float>(pi);
        const C3f radiance = check.view.pixels[i].emission + response * values[k].irradiance;
        check.truth.pixels[i] = radiance;
        if (!compared[i]) continue;
        ours.add(check.ours.pixels[i], radiance);
        povray.add(check.povray.picture.pixels[i], radiance);
        noise += mean_of(response * values[k].standard_error);
        sum += mean_of(radiance);
    }
    check.our_error = ours.figures();
    check.povray_error = povray.figures();
    check.truth_noise = sum > 0 ? noise / sum : 0;
}

}  // namespace

LitPicture light_and_draw(const Scene& scene, const CrosscheckConfig& config) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    LitPicture lit;
    lit.cloud = light_points(scene, config);
    lit.picture =
        render_picture(lit.cloud, scene.cameras.at(0), {.width = config.width, .height = config.height}, &scene);
    lit.processor_seconds = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
    lit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return lit;
}

Crosscheck cross_check(const Scene& scene, const CrosscheckConfig& config) {
    const Camera& camera = scene.cameras.at(0);
    Crosscheck check;
    check.view = view_surface(scene, camera, config.width, config.height);
    check.pixels = pixels_to_compare(scene, check.view);

    const LitPicture lit = light_and_draw(scene, config);
    check.ours = lit.picture;
    check.our_seconds = lit.processor_seconds;

    PovConfig povray;
    povray.preset = config.preset;
    povray.bounces = config.direct_only ? 0 : config.bounces;
    povray.camera = camera;
    povray.width = config.width;
    povray.height = config.height;
    check.povray = render_by_povray(scene, povray, config.cache);

    Pairs picture;
    for (const std::size_t i : check.pixels) picture.add(check.ours.pixels[i], check.povray.picture.pixels[i]);
    check.picture = picture.figures();
    compare_files(write_and_read(lit.cloud), check);
    compare_with_truth(scene, config, check);
    return check;
}

}  // namespace vmap::crosscheck

// SPDX-License-Identifier: GPL-3.0-or-later
#include "paint.h"
#include "paint_image.h"
#include "pov_frame.h"
#include "pov_mesh.h"
#include "pov_setting.h"
#include "pov_text.h"

#include <vmap/error.h>
#include <vmap/exporters/camera_placement.h>
#include <vmap/exporters/exr.h>
#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/pov_scene.h>
#include <vmap/printable.h>
#include <vmap/surface_shading.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

namespace vmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Writes one scene; each function writes a part of the file.
class PovSceneWriter {
public:
    PovSceneWriter(const Scene& scene, std::string path, const OutputInfo& info, const PovConfig& config)
        : scene_(scene),
          path_(std::move(path)),
          info_(info),
          config_(config),
          frame_(bounds_of(scene), info.up),
          stem_(plain_name(fs::path(path_).stem().string())) {
        check_config(config, path_);
        choose_paints();
    }

    PovExport write() {
        FileWriter file(path_);
        result_.files.push_back(path_);
        PovText text(file);
        const std::string sky_file = config_.sky_picture ? add_image("sky.exr", write_sky_image()) : "";
        write_header(text, path_, info_, config_, frame_);
        write_globals(text, config_);
        write_sky(text, config_, frame_, sky_file);
        text.line("{}", pov_camera(camera(), frame_));
        write_lights(text, scene_.lights, frame_, path_);
        write_textures(text);
        write_meshes(text);
        write_instances(text);
        text.flush();

        write_images();
        file.finish();
        for (Output& output : images_) output.file->commit();
        file.commit();
        return std::move(result_);
    }

private:
    using WriteImage = std::function<void(FileWriter&)>;

    /// A file beside the scene.
    struct Output {
        std::string path;
        WriteImage write;
        std::unique_ptr<FileWriter> file;
    };

    /// A declared texture and the meshes that wear it.
    struct Look {
        Paint paint;
        std::size_t mesh = none;  ///< of a paint that is not shared
        std::optional<TileLayout> tiles;
    };

    void choose_paints() {
        first_instance_.assign(scene_.meshes.size(), none);
        for (std::size_t i = scene_.instances.size(); i-- > 0;) first_instance_[scene_.instances[i].mesh] = i;

        std::map<std::tuple<PaintKind, std::size_t, float, float, float, float>, std::size_t> shared;
        look_of_mesh_.assign(scene_.meshes.size(), none);
        for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
            const Mesh& mesh = scene_.meshes[i];
            if (first_instance_[i] == none || mesh.triangle_count() == 0) continue;
            const Paint paint = choose_paint(scene_, mesh);
            if (!paint.visible) continue;
            const bool own = paint.kind == PaintKind::tiles || paint.kind == PaintKind::per_vertex;
            const auto key =
                std::tuple(paint.kind, paint.material, paint.tint.r, paint.tint.g, paint.tint.b, paint.tint.a);
            std::size_t look = looks_.size();
            if (!own) look = shared.try_emplace(key, look).first->second;
            look_of_mesh_[i] = look;
            if (look < looks_.size()) continue;
            looks_.push_back({paint, own ? i : none, std::nullopt});
            if (paint.kind == PaintKind::tiles) looks_.back().tiles = layout_tiles(scene_, mesh);
        }
    }

    [[nodiscard]] Camera camera() {
        if (config_.camera) return *config_.camera;
        if (!scene_.cameras.empty()) return scene_.cameras.front();
        result_.warnings.push_back(header_text(scene_.source) + ": no camera, one is placed to see everything");
        return place_camera(bounds_of(scene_), static_cast<double>(config_.width) / config_.height);
    }

    /// Returns the name by which the scene finds the image.
    std::string add_image(const std::string& suffix, WriteImage write) {
        if (path_ == "-") throw UsageError("standard output: the scene needs images beside it, expected a file name");
        const std::string name = stem_ + "-" + suffix;
        images_.push_back({(fs::path(path_).parent_path() / name).string(), std::move(write), nullptr});
        result_.files.push_back(images_.back().path);
        return name;
    }

    [[nodiscard]] WriteImage write_sky_image() const {
        return [this](FileWriter& file) { write_exr(file, *config_.sky_picture, info_); };
    }

    [[nodiscard]] WriteImage write_paint_image(std::size_t index, PaintLayer layer) const {
        return [this, index, layer](FileWriter& file) {
            const Look& look = looks_[index];
            const PaintImage image = look.tiles
                                         ? tiles_of_paint(*shading_, first_instance_[look.mesh], *look.tiles, layer)
                                         : image_of_paint(scene_, look.paint, layer);
            write_png_image(file, image.view());
        };
    }

    void write_textures(PovText& text) {
        for (std::size_t i = 0; i < looks_.size(); ++i) {
            const Paint& paint = looks_[i].paint;
            const Material& material = scene_.materials[paint.material];
            check_colors(material);
            if (paint.kind == PaintKind::tiles && !shading_) shading_ = std::make_unique<SurfaceShading>(scene_);

            PovPigment albedo{.color = plain_albedo(material, paint.tint), .image = "", .nearest = false};
            albedo.nearest = paint.kind == PaintKind::image && paint.view.nearest;
            if (paint.has_albedo_image)
                albedo.image = add_image(fmt::format("albedo-{}.png", i), write_paint_image(i, PaintLayer::albedo));
            std::string emission_image;
            if (paint.has_emission_image)
                emission_image =
                    add_image(fmt::format("emission-{}.png", i), write_paint_image(i, PaintLayer::emission));

            text.line("// {}", header_text(material.name));
            text.line("#declare texture_{} = texture {{ {} }}", i,
                      texture_body(albedo, material.emission, emission_image));
            if (!material.double_sided)
                text.line("#declare back_texture_{} = texture {{ {} }}", i,
                          back_texture_body(albedo, material.alpha_mode == AlphaMode::mask));
        }
        text.line("");
    }

    void check_colors(const Material& material) const {
        const float numbers[] = {material.base_color.r, material.base_color.g, material.base_color.b,
                                 material.base_color.a, material.metallic,     material.emission.x,
                                 material.emission.y,   material.emission.z};
        if (!std::all_of(std::begin(numbers), std::end(numbers), [](float number) { return std::isfinite(number); }))
            throw UnsupportedInput(printable(path_) + ": material '" + header_text(material.name) +
                                   "' has a number that is not finite");
    }

    [[nodiscard]] PovMeshStyle style_of(std::size_t mesh) const {
        const std::size_t index = look_of_mesh_[mesh];
        const Look& look = looks_[index];
        PovMeshStyle style;
        style.paint = &look.paint;
        style.tiles = look.tiles;
        style.texture = fmt::format("texture_{}", index);
        if (!scene_.materials[look.paint.material].double_sided)
            style.back_texture = fmt::format("back_texture_{}", index);
        style.shading_normals = config_.shading_normals;
        return style;
    }

    void write_meshes(PovText& text) {
        for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
            if (look_of_mesh_[i] == none) continue;
            text.line("// {}", header_text(scene_.meshes[i].name));
            text.add("#declare mesh_{} = ", i);
            write_mesh2(text, scene_, scene_.meshes[i], style_of(i), path_);
        }
        text.line("");
    }

    void write_instances(PovText& text) {
        for (const Instance& instance : scene_.instances) {
            if (look_of_mesh_[instance.mesh] == none) continue;
            const Imath::M44d placed = instance.world_from_mesh * frame_.frame_from_world;
            check_transform(placed, instance);
            if (is_invertible(placed)) {
                text.line("object {{ mesh_{} {} }} // {}", instance.mesh, pov_matrix(placed),
                          header_text(instance.name));
                continue;
            }
            PovMeshStyle style = style_of(instance.mesh);
            style.transform = placed;
            write_mesh2(text, scene_, scene_.meshes[instance.mesh], style, path_);
        }
    }

    void check_transform(const Imath::M44d& transform, const Instance& instance) const {
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column)
                if (!std::isfinite(transform[row][column]))
                    throw UnsupportedInput(printable(path_) + ": object '" + header_text(instance.name) +
                                           "' has a transform that is not finite");
    }

    /// POV-Ray alters transforms that flatten an object.
    [[nodiscard]] static bool is_invertible(const Imath::M44d& m) {
        constexpr double least_scale = 1e-8, least_volume = 1e-6;
        const Imath::V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
        const double lengths = x.length() * y.length() * z.length();
        return std::min({x.length(), y.length(), z.length()}) > least_scale &&
               std::abs(x.dot(y.cross(z))) > least_volume * lengths;
    }

    void write_images() {
        tbb::parallel_for(std::size_t{0}, images_.size(), [&](std::size_t i) {
            images_[i].file = std::make_unique<FileWriter>(images_[i].path);
            images_[i].write(*images_[i].file);
            images_[i].file->finish();
        });
    }

    const Scene& scene_;
    std::string path_;
    const OutputInfo& info_;
    const PovConfig& config_;
    PovFrame frame_;
    std::string stem_;
    std::vector<std::size_t> first_instance_;  ///< by mesh
    std::vector<std::size_t> look_of_mesh_;    ///< none for meshes that do not show
    std::vector<Look> looks_;
    std::vector<Output> images_;
    std::unique_ptr<SurfaceShading> shading_;  ///< when a paint is tiled
    PovExport result_;
};

}  // namespace

PovExport write_pov_scene(const Scene& scene, const std::string& path, const OutputInfo& info,
                          const PovConfig& config) {
    return PovSceneWriter(scene, path, info, config).write();
}

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The second half of every job: the files named by -o, all opened before the long work and put in place together.
#pragma once

#include "job.h"

#include <vmap/exporters/file_writer.h>
#include <vmap/exporters/output_info.h>
#include <vmap/exporters/picture.h>
#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <Imath/ImathBox.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

enum class OutputFormat { ply, gltf, vdb, exr, png };

struct OutputOptions {
    std::vector<std::string> paths;
    std::optional<UpAxis> up;        ///< default: y for glTF, z for PLY and VDB
    bool vdb_points = false;         ///< VDB files hold points instead of a grid
    std::optional<double> voxel;     ///< edge of the grid's voxels, world units; default from the spacing
    std::optional<double> exposure;  ///< of display colours; default automatic
    std::string size = "512";        ///< of pictures: WIDTHxHEIGHT, or HEIGHT by the camera's aspect
    std::string camera;              ///< name or index of the scene's camera
};

void add_output_options(CLI::App& app, OutputOptions& options);

/// Width and height of a picture.
/// - throws UsageError unless both are within 1 and 16384
[[nodiscard]] std::pair<int, int> parse_size(const std::string& size, double aspect);

/// The scene's camera by name or index, its first one, or one that sees all of the bounds, with a warning.
[[nodiscard]] Camera choose_camera(const Scene& scene, const Imath::Box3d& bounds, const std::string& wanted, Job& job);

/// Exposure of pictures and display colours; `wanted` or an automatic one.
[[nodiscard]] double choose_exposure(const std::optional<double>& wanted, const LitCloud& cloud);

class Outputs {
public:
    /// Opens every file, so that one that cannot be written is found out before the work.
    /// - throws UsageError for an unknown extension or size, FileError for what cannot be written
    explicit Outputs(const OutputOptions& options);

    [[nodiscard]] bool needs_picture() const;

    /// Writes the files and puts them in place.
    /// - scene: what the points were sampled from; without instances when there was none
    /// - also: one more file that appears together with them, such as a report; may be null
    void write(const LitCloud& cloud, const Scene& scene, OutputInfo info, Job& job);

    /// Puts all files in place, none before all are complete.
    void commit(Job& job, FileWriter* also = nullptr);

    [[nodiscard]] const std::vector<std::string>& paths() const { return options_.paths; }

private:
    struct Output {
        OutputFormat format;
        FileWriter file;
    };

    [[nodiscard]] OutputInfo info_for(OutputFormat format, OutputInfo info) const;

    OutputOptions options_;
    std::vector<Output> outputs_;
};

}  // namespace vmap

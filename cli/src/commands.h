// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sub-commands of the program. Each adds its parser and returns what to run.
#pragma once

#include "job.h"

namespace vmap {

[[nodiscard]] Command add_light_command(CLI::App& program);
[[nodiscard]] Command add_sample_command(CLI::App& program);
[[nodiscard]] Command add_info_command(CLI::App& program);
[[nodiscard]] Command add_render_command(CLI::App& program);
[[nodiscard]] Command add_export_command(CLI::App& program);
[[nodiscard]] Command add_compare_command(CLI::App& program);
[[nodiscard]] Command add_build_command(CLI::App& program);
[[nodiscard]] Command add_query_command(CLI::App& program);

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two files, pictures or lit clouds, compared and judged.
#pragma once

#include <vmap/compare/compare_clouds.h>
#include <vmap/compare/compare_pictures.h>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vmap {

/// Pictures that were compared, and what came out.
struct ComparedPictures {
    Picture result;
    Picture reference;
    bool radiance = false;  ///< linear values of any size; else what a display shows
    PictureComparison comparison;
};

struct Comparison {
    std::string result;     ///< name of the file
    std::string reference;  ///< name of the file
    std::optional<ComparedPictures> pictures;
    std::optional<CloudComparison> clouds;

    [[nodiscard]] const DifferenceFigures& figures() const {
        return pictures ? pictures->comparison.figures : clouds->figures;
    }
    [[nodiscard]] const DifferenceHistogram& histogram() const {
        return pictures ? pictures->comparison.histogram : clouds->histogram;
    }
};

/// Reads both files and compares the first with the second: pictures (EXR, PNG) by pixel, clouds (any file of lit
/// points) by nearest point.
///
/// Throws FileError or UnsupportedInput for a file that cannot be read, UsageError for files that cannot be compared
/// with each other.
[[nodiscard]] Comparison compare_files(const std::filesystem::path& result, const std::filesystem::path& reference);

/// What a comparison may show at most, as fractions of the mean of the reference; FLIP as it is. Empty: anything.
struct ComparisonLimits {
    std::optional<double> mean;
    std::optional<double> median;
    std::optional<double> p95;
    std::optional<double> p99;
    std::optional<double> rmse;
    std::optional<double> bias;  ///< of its absolute value
    std::optional<double> flip;  ///< pictures only
};

/// One line for each limit that is exceeded, as in "median 0.012 is above 0.003". A figure that is not a number exceeds
/// every limit. Throws UsageError when FLIP is limited and clouds were compared.
[[nodiscard]] std::vector<std::string> exceeded_limits(const Comparison& comparison, const ComparisonLimits& limits);

/// The figures under fixed names.
[[nodiscard]] nlohmann::json json_of(const Comparison& comparison);

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/comparison.h>
#include <vmap/compare/picture_file.h>
#include <vmap/error.h>
#include <vmap/importers/input.h>
#include <vmap/printable.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace vmap {
namespace {

bool is_exr(const std::filesystem::path& file) {
    return is_picture(file) && file.extension() != ".png" && file.extension() != ".PNG";
}

LitCloud read_cloud(const std::filesystem::path& file) {
    Input input = read_input(file);
    if (!input.points || input.points->cloud.irradiance.empty())
        throw UsageError(printable(file.string()) + ": holds no points with irradiance, expected a lit cloud");
    return std::move(input.points->cloud);
}

}  // namespace

Comparison compare_files(const std::filesystem::path& result, const std::filesystem::path& reference) {
    Comparison comparison;
    comparison.result = result.string();
    comparison.reference = reference.string();
    const bool pictures = is_picture(result);
    if (pictures != is_picture(reference))
        throw UsageError(fmt::format("{} and {}: one is a picture and the other is not, expected two of a kind",
                                     printable(comparison.result), printable(comparison.reference)));
    if (!pictures) {
        comparison.clouds = compare_clouds(read_cloud(result), read_cloud(reference));
        return comparison;
    }
    ComparedPictures compared;
    compared.result = read_picture(result);
    compared.reference = read_picture(reference);
    if (compared.result.width != compared.reference.width || compared.result.height != compared.reference.height)
        throw UsageError(fmt::format("{} is {} x {} pixels and {} {} x {}, expected the same size",
                                     printable(comparison.result), compared.result.width, compared.result.height,
                                     printable(comparison.reference), compared.reference.width,
                                     compared.reference.height));
    compared.radiance = is_exr(result) && is_exr(reference);
    compared.comparison =
        compare_pictures(compared.result, compared.reference, compared.radiance ? FlipRange::high : FlipRange::display);
    comparison.pictures = std::move(compared);
    return comparison;
}

std::vector<std::string> exceeded_limits(const Comparison& comparison, const ComparisonLimits& limits) {
    std::vector<std::string> lines;
    const auto check = [&](const char* name, double value, const std::optional<double>& limit) {
        if (limit && !(value <= *limit)) lines.push_back(fmt::format("{} {:.4g} is above {:.4g}", name, value, *limit));
    };
    const DifferenceFigures& figures = comparison.figures();
    check("mean", figures.mean, limits.mean);
    check("median", figures.median, limits.median);
    check("p95", figures.p95, limits.p95);
    check("p99", figures.p99, limits.p99);
    check("rmse", figures.rmse, limits.rmse);
    check("bias", std::abs(figures.bias), limits.bias);
    if (limits.flip && !comparison.pictures) throw UsageError("FLIP is defined for pictures only");
    if (comparison.pictures) check("flip", comparison.pictures->comparison.flip, limits.flip);
    return lines;
}

nlohmann::json json_of(const Comparison& comparison) {
    const DifferenceFigures& figures = comparison.figures();
    nlohmann::json json{{"result", comparison.result}, {"reference", comparison.reference},
                        {"count", figures.count},      {"mean_reference", figures.mean_reference},
                        {"mean", figures.mean},        {"median", figures.median},
                        {"p95", figures.p95},          {"p99", figures.p99},
                        {"largest", figures.largest},  {"rmse", figures.rmse},
                        {"bias", figures.bias}};
    if (comparison.pictures) {
        json["width"] = comparison.pictures->reference.width;
        json["height"] = comparison.pictures->reference.height;
        json["flip"] = comparison.pictures->comparison.flip;
    } else {
        json["mean_distance"] = comparison.clouds->mean_distance;
        json["spacing"] = comparison.clouds->spacing;
    }
    return json;
}

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/page.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace vmap::crosscheck {
namespace {

constexpr std::string_view page_start = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>V-map: cross-check</title><style>
body{font:15px/1.4 sans-serif;margin:2em auto;max-width:1240px;padding:0 1em;color:#222;background:#fff}
h1{font-size:1.4em}h2{font-size:1.1em;margin:2em 0 .3em}p{margin:.4em 0;max-width:60em}
table{border-collapse:collapse;margin:.6em 0}td,th{padding:.15em .9em .15em 0;text-align:left;white-space:nowrap}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}thead td,th{border-bottom:1px solid #bbb}
.pictures{display:flex;flex-wrap:wrap;gap:8px}figure{margin:0}figcaption{font-size:.85em}
img{image-rendering:pixelated;display:block;width:232px}.scale{display:flex;justify-content:space-between}
img.scale-bar{height:8px;margin-top:3px}small{color:#666}</style></head><body>
<h1>The light of the V-map, beside POV-Ray and a path tracer</h1>
<p>Each scene is lit as points and drawn by <code>vmap</code>, exported with its source meshes and drawn by POV-Ray, and
path-traced over the source triangles at the middle of every pixel; the three share no light code. POV-Ray's radiosity is
cached and interpolated, so where it differs from the path tracer the difference is shown, not hidden: both are measured
against the path-traced picture, whose own noise is stated.</p>
<p>Figures are |difference| (mean of the channels) divided by the mean of the reference, over the pixels that show one lit
surface alone: pixels on borders of things and on lamps, and near the edges of shadows that points, spots and suns cast, are
left out and grey in the maps.</p>
)";

double mean_difference(const Imath::C3f& a, const Imath::C3f& b) {
    return (std::abs(static_cast<double>(a.x) - b.x) + std::abs(static_cast<double>(a.y) - b.y) +
            std::abs(static_cast<double>(a.z) - b.z)) /
           3;
}

/// Error of each compared pixel as a fraction of the mean of the truth; -1 elsewhere.
std::vector<double> errors_of(const Picture& picture, const Crosscheck& check) {
    std::vector<double> errors(picture.pixels.size(), -1);
    const double mean = check.our_error.mean_reference > 0 ? check.our_error.mean_reference : 1;
    for (const std::size_t i : check.pixels)
        errors[i] = mean_difference(picture.pixels[i], check.truth.pixels[i]) / mean;
    return errors;
}

ShownPicture error_map(const Picture& picture, const Crosscheck& check) {
    return shown_map(picture.width, picture.height, errors_of(picture, check), error_scale(check));
}

std::string figure(const ShownPicture& picture, std::string_view caption) {
    return fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                       png_data_uri(picture), caption, caption);
}

std::string map_figure(const ShownPicture& picture, std::string_view caption, double top) {
    return fmt::format(
        "<figure><img src=\"{}\" alt=\"{}\"><img class=\"scale-bar\" src=\"{}\" alt=\"scale\"><figcaption>"
        "<div class=\"scale\"><span>0</span><span>{}</span><span>{:g} %</span></div></figcaption></figure>\n",
        png_data_uri(picture), caption, png_data_uri(shown_scale()), caption, 100 * top);
}

std::string figures_row(std::string_view name, const DifferenceFigures& figures) {
    return fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td>"
        "<td class=\"n\">{:.3f}</td><td class=\"n\">{:+.3f}</td><td class=\"n\">{}</td></tr>\n",
        name, 100 * figures.median, 100 * figures.mean, 100 * figures.p95, 100 * figures.p99, 100 * figures.bias,
        figures.count);
}

std::string figures_table(const Crosscheck& check) {
    std::string table =
        "<table><thead><tr><th>percent of the mean</th><th class=\"n\">median</th><th class=\"n\">mean</th>"
        "<th class=\"n\">p95</th><th class=\"n\">p99</th><th class=\"n\">bias</th><th class=\"n\">places</th></tr>"
        "</thead>\n";
    table += figures_row("our picture from the path tracer's", check.our_error);
    table += figures_row("POV-Ray's picture from the path tracer's", check.povray_error);
    table += figures_row("our picture from POV-Ray's", check.picture);
    table += figures_row("irradiance in our PLY file from POV-Ray's", check.ply);
    table += figures_row("irradiance in our OpenVDB file from POV-Ray's", check.vdb);
    return table + "</table>\n";
}

std::string times_of(const Crosscheck& check) {
    return fmt::format(
        "<p>Light and picture by vmap: {:.2f} processor seconds. POV-Ray: {:.1f} (<code>{}</code>). Noise of the path "
        "tracer: {:.2f} % of the mean.</p>\n",
        check.our_seconds, check.povray.seconds, check.povray.options, 100 * check.truth_noise);
}

}  // namespace

double error_scale(const Crosscheck& check) {
    return scale_end(std::max({0.01, check.our_error.p99, check.povray_error.p95}));
}

ShownPicture picture_row(const Crosscheck& check) {
    const double exposure = exposure_for(check.truth);
    const std::vector<ShownPicture> parts{
        shown_picture(check.ours, exposure), shown_picture(check.povray.picture, exposure),
        shown_picture(check.truth, exposure), error_map(check.ours, check), error_map(check.povray.picture, check)};
    constexpr int gap = 4;
    const int width = check.ours.width;
    const int height = check.ours.height;
    const int count = static_cast<int>(parts.size());
    ShownPicture row{.width = count * (width + gap) - gap, .height = height, .rgb = {}};
    row.rgb.assign(std::size_t{3} * static_cast<std::size_t>(row.width) * static_cast<std::size_t>(height), 255);
    for (int k = 0; k < count; ++k)
        for (int y = 0; y < height; ++y)
            std::copy_n(parts[static_cast<std::size_t>(k)].rgb.begin() + std::ptrdiff_t{3} * y * width, 3 * width,
                        row.rgb.begin() + std::ptrdiff_t{3} * (y * row.width + k * (width + gap)));
    return row;
}

void Page::add(const Case& item, const Crosscheck& check) {
    rows_.push_back(
        fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"n\">{1:.2f}</td><td class=\"n\">{2:.2f}</td>"
                    "<td class=\"n\">{3:.2f}</td><td class=\"n\">{4:.2f}</td><td class=\"n\">{5:.2f}</td><td "
                    "class=\"n\">{6:.2f}</td>"
                    "<td class=\"n\">{7:.2f}</td><td class=\"n\">{8:.1f}</td></tr>\n",
                    item.name, 100 * check.our_error.median, 100 * check.our_error.mean, 100 * check.our_error.p95,
                    100 * check.povray_error.median, 100 * check.povray_error.mean, 100 * check.povray_error.p95,
                    check.our_seconds, check.povray.seconds));

    const double exposure = exposure_for(check.truth);
    const double top = error_scale(check);
    std::string section = fmt::format("<h2 id=\"{0}\">{1}</h2>\n<p><small>{0}</small></p>\n<div class=\"pictures\">\n",
                                      item.name, item.about);
    section += figure(shown_picture(check.ours, exposure), "vmap");
    section += figure(shown_picture(check.povray.picture, exposure), "POV-Ray");
    section += figure(shown_picture(check.truth, exposure), "path tracer");
    section += map_figure(error_map(check.ours, check), "error of vmap", top);
    section += map_figure(error_map(check.povray.picture, check), "error of POV-Ray", top);
    section += "</div>\n" + figures_table(check) + times_of(check);
    sections_.push_back(std::move(section));
}

std::string Page::html(const std::string& povray, const std::string& date) const {
    std::string text(page_start);
    text += fmt::format("<p>POV-Ray {}; made on {} by <code>scripts/crosscheck</code>.</p>\n", povray, date);
    text +=
        "<table><thead><tr><td></td><td colspan=\"3\">error of vmap, %</td><td colspan=\"3\">error of POV-Ray, "
        "%</td><td colspan=\"2\">processor seconds</td></tr><tr><th>scene</th>";
    for (const char* name : {"median", "mean", "p95", "median", "mean", "p95", "vmap", "POV-Ray"})
        text += fmt::format("<th class=\"n\">{}</th>", name);
    text += "</tr></thead>\n";
    for (const std::string& row : rows_) text += row;
    text += "</table>\n";
    for (const std::string& section : sections_) text += section;
    return text + "</body></html>\n";
}

}  // namespace vmap::crosscheck

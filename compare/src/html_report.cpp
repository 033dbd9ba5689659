// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/compare/html_report.h>
#include <vmap/compare/shown_picture.h>
#include <vmap/printable.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace vmap {
namespace {

constexpr std::string_view page_start = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>vmap compare</title><style>
body{font:15px/1.4 sans-serif;margin:2em auto;max-width:1100px;padding:0 1em;color:#222;background:#fff}
h1{font-size:1.3em}h2{font-size:1.05em;margin:1.6em 0 .4em}
table{border-collapse:collapse}td,th{padding:.15em .9em .15em 0;text-align:left}td.n{text-align:right}
img{image-rendering:pixelated;display:block}
.stack{position:relative;display:inline-block;background:#000}.stack img+img{position:absolute;left:0;top:0}
.flicker #a{animation:flicker 1s steps(1) infinite}@keyframes flicker{50%{visibility:hidden}}
.maps{display:flex;flex-wrap:wrap;gap:1.5em}.scale{display:flex;justify-content:space-between;font-size:.85em}
small{color:#666}</style></head><body>
)";

constexpr std::string_view picture_script = R"(<script>
const stack=document.getElementById('stack'),a=document.getElementById('a'),slider=document.getElementById('slider');
const cut=()=>{a.style.clipPath='inset(0 '+(100-slider.value)+'% 0 0)'};
slider.oninput=cut;cut();
document.getElementById('flicker').onchange=e=>{stack.classList.toggle('flicker',e.target.checked);
a.style.clipPath=e.target.checked?'none':'';slider.disabled=e.target.checked;if(!e.target.checked)cut()};
</script>
)";

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : printable(text)) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string percent(double fraction) {
    return fmt::format("{:.3f} %", 100 * fraction);
}

std::string figures_table(const Comparison& comparison) {
    const DifferenceFigures& figures = comparison.figures();
    std::string rows;
    const auto add = [&](std::string_view name, const std::string& value) {
        rows += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", name, value);
    };
    add("mean difference", percent(figures.mean));
    add("median", percent(figures.median));
    add("95th percentile", percent(figures.p95));
    add("99th percentile", percent(figures.p99));
    add("largest", percent(figures.largest));
    add("root of mean square", percent(figures.rmse));
    add("bias (signed)", fmt::format("{:+.3f} %", 100 * figures.bias));
    if (comparison.pictures) add("FLIP", fmt::format("{:.4f}", comparison.pictures->comparison.flip));
    add("mean of the reference", fmt::format("{:.5g}", figures.mean_reference));
    add(comparison.pictures ? "pixels" : "points", fmt::format("{}", figures.count));
    if (comparison.clouds)
        add("distance to the nearest point",
            fmt::format("{:.3g} (spacing {:.3g})", comparison.clouds->mean_distance, comparison.clouds->spacing));
    return fmt::format("<table>\n{}</table>\n<p><small>Percentages are of the mean of the reference.</small></p>\n",
                       rows);
}

/// Bars over a logarithmic axis from 0.001 % to 100 %.
std::string histogram_figure(const DifferenceHistogram& histogram) {
    constexpr double width = 640;
    constexpr double height = 160;
    const double highest = std::max(1e-9, *std::max_element(histogram.shares.begin(), histogram.shares.end()));
    const double step = width / static_cast<double>(histogram.shares.size());
    std::string bars;
    for (std::size_t i = 0; i < histogram.shares.size(); ++i) {
        const double size = histogram.shares[i] / highest * height;
        bars += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"><title>{}</title></rect>)",
                            static_cast<double>(i) * step, height - size, step - 1, size,
                            fmt::format("{} to {}: {}", percent(histogram.bounds[i]), percent(histogram.bounds[i + 1]),
                                        percent(histogram.shares[i])));
    }
    std::string labels;
    constexpr std::array<const char*, 6> decades{"0.001 %", "0.01 %", "0.1 %", "1 %", "10 %", "100 %"};
    for (std::size_t i = 0; i < decades.size(); ++i)
        labels += fmt::format(R"(<text x="{:.0f}" y="{:.0f}" text-anchor="middle" fill="#222">{}</text>)",
                              width * static_cast<double>(i) / (decades.size() - 1), height + 16, decades[i]);
    return fmt::format(
        "<h2>Histogram of the differences</h2>\n<svg viewBox=\"-30 0 {:.0f} {:.0f}\" width=\"{:.0f}\" "
        "font-size=\"11\" fill=\"#902c7f\">{}{}</svg>\n",
        width + 60, height + 24, width + 60, bars, labels);
}

std::string map_figure(std::string_view title, const std::string& uri, int shown_width, std::string_view top) {
    return fmt::format(
        "<div><h2>{}</h2><img src=\"{}\" width=\"{}\" alt=\"{}\">"
        "<img src=\"{}\" width=\"{}\" height=\"10\" alt=\"scale\" style=\"margin-top:6px\">"
        "<div class=\"scale\"><span>0</span><span>{}</span></div></div>\n",
        title, uri, shown_width, title, png_data_uri(shown_scale()), shown_width, top);
}

std::string picture_figures(const Comparison& comparison) {
    const ComparedPictures& pictures = *comparison.pictures;
    const int width = pictures.reference.width;
    const int height = pictures.reference.height;
    // Small pictures are shown large enough to be judged.
    const int shown = width < 480 ? width * ((480 + width - 1) / width) : std::min(width, 1000);
    const double exposure = pictures.radiance ? exposure_for(pictures.reference) : 1;
    const double mean = comparison.figures().mean_reference > 0 ? comparison.figures().mean_reference : 1;
    const double top = scale_end(comparison.figures().p99);
    const std::vector<double> flip(pictures.comparison.flip_map.begin(), pictures.comparison.flip_map.end());

    std::string html = fmt::format(
        "<h2>Left of the slider {}, right of it {}</h2>\n<div class=\"stack\" id=\"stack\">"
        "<img src=\"{}\" width=\"{}\" alt=\"reference\"><img id=\"a\" src=\"{}\" width=\"{}\" alt=\"result\"></div>\n"
        "<p><input type=\"range\" id=\"slider\" min=\"0\" max=\"100\" value=\"50\" style=\"width:{}px\"><br>"
        "<label><input type=\"checkbox\" id=\"flicker\"> flicker</label>",
        escaped(comparison.result), escaped(comparison.reference),
        png_data_uri(shown_picture(pictures.reference, exposure)), shown,
        png_data_uri(shown_picture(pictures.result, exposure)), shown, shown);
    if (pictures.radiance) html += fmt::format(" <small>exposure {:.4g}</small>", exposure);
    html += "</p>\n<div class=\"maps\">\n";
    html += map_figure("Difference", png_data_uri(shown_map(width, height, pictures.comparison.difference, top * mean)),
                       shown, fmt::format("{:g} % of the mean of the reference and more", 100 * top));
    html += map_figure("FLIP", png_data_uri(shown_map(width, height, flip, 1)), shown, "1");
    html += "</div>\n";
    html += picture_script;
    return html;
}

}  // namespace

void write_html_report(FileWriter& file, const Comparison& comparison) {
    std::ostream& stream = file.stream();
    stream << page_start;
    stream << "<h1>" << escaped(comparison.result) << " against " << escaped(comparison.reference) << "</h1>\n";
    stream << figures_table(comparison);
    if (comparison.pictures) stream << picture_figures(comparison);
    stream << histogram_figure(comparison.histogram());
    stream << "</body></html>\n";
}

}  // namespace vmap

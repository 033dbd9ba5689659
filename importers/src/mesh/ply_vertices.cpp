// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_vertices.h"

#include "../content_error.h"
#include "colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace vmap {
namespace {

using Imath::C3f;
using Imath::V3d;
using Imath::V3f;

using Names = std::array<const char*, 3>;

/// Columns that one pass over the vertices fills.
class Columns {
public:
    explicit Columns(const PlyElement& vertex) : vertex_(vertex) {}

    /// Whether the file has all of these as single numbers.
    [[nodiscard]] bool has(std::initializer_list<const char*> names) const {
        return std::all_of(names.begin(), names.end(), [&](const char* name) { return find(name).has_value(); });
    }
    [[nodiscard]] bool has(const Names& names) const { return has({names[0], names[1], names[2]}); }

    [[nodiscard]] std::size_t count() const { return vertex_.count; }
    [[nodiscard]] PlyType type(const char* name) const { return vertex_.properties[index_of(name)].type; }

    template <class Vector, class Scalar = typename Vector::BaseType>
    void add(const Names& names, std::vector<Vector>& to) {
        to.resize(count());
        for (std::size_t k = 0; k < names.size(); ++k)
            columns_.push_back({index_of(names[k]), reinterpret_cast<Scalar*>(to.data()) + k, names.size()});
    }
    template <class Scalar>
    void add(const char* name, std::vector<Scalar>& to) {
        to.resize(count());
        columns_.push_back({index_of(name), to.data(), 1});
    }
    void add(const std::array<const char*, 2>& names, std::vector<Imath::V2f>& to) {
        to.resize(count());
        for (std::size_t k = 0; k < names.size(); ++k) columns_.push_back({index_of(names[k]), &to.data()->x + k, 2});
    }

    void read(PlyElements& elements) const { elements.read(vertex_, columns_); }

private:
    /// Of a property that the file has.
    [[nodiscard]] std::size_t index_of(const char* name) const {
        const auto found = find(name);
        assert(found);
        return found ? *found : 0;
    }

    [[nodiscard]] std::optional<std::size_t> find(const char* name) const {
        const std::optional<std::size_t> found = vertex_.find(name);
        return found && !vertex_.properties[*found].is_list() ? found : std::nullopt;
    }

    const PlyElement& vertex_;
    std::vector<PlyColumn> columns_;
};

constexpr Names position_names{"x", "y", "z"};
constexpr Names normal_names{"nx", "ny", "nz"};
constexpr Names irradiance_names{"irradiance_r", "irradiance_g", "irradiance_b"};
constexpr Names albedo_names{"albedo_r", "albedo_g", "albedo_b"};
constexpr Names emission_names{"emission_r", "emission_g", "emission_b"};
constexpr Names color_names[] = {
    {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};
constexpr std::array<const char*, 2> texcoord_names[] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};

bool is_finite(float value) {
    return std::isfinite(value);
}
bool is_finite(const V3f& value) {
    return is_finite(value.x) && is_finite(value.y) && is_finite(value.z);
}

template <class T>
void expect_finite(const std::vector<T>& values, const char* what) {
    const auto bad = std::find_if(values.begin(), values.end(), [](const T& value) { return !is_finite(value); });
    if (bad != values.end())
        throw BrokenContent(fmt::format("vertex {} has {} that is not a finite number", bad - values.begin(), what));
}

template <class Vector>
void expect_usable(const std::vector<Vector>& positions) {
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!is_usable_coordinate(positions[i][axis]))
                throw BrokenContent(
                    fmt::format("vertex {} has the coordinate {}, expected a finite number of at most 1e18", i,
                                positions[i][axis]));
}

/// Whether floats hold every value of the type.
bool fits_float(PlyType type) {
    return type != PlyType::float64 && type != PlyType::int32 && type != PlyType::uint32;
}

/// The point of our own file or one like it: what the vertices hold apart from what a soup has a place for.
PointFile add_point_columns(Columns& columns) {
    PointFile file;
    PointCloud& points = file.cloud.points;
    if (columns.has(albedo_names)) columns.add(albedo_names, points.albedo);
    if (columns.has(emission_names)) columns.add(emission_names, points.emission);
    if (columns.has(irradiance_names)) columns.add(irradiance_names, file.cloud.irradiance);
    if (columns.has({"area"})) columns.add("area", points.areas);
    if (columns.has({"face_id"})) columns.add("face_id", points.faces);
    if (columns.has({"material_id"})) columns.add("material_id", points.materials);
    return file;
}

void expect_finite(const LitCloud& cloud) {
    expect_finite(cloud.points.albedo, "an albedo");
    expect_finite(cloud.points.emission, "an emission");
    expect_finite(cloud.irradiance, "an irradiance");
    expect_finite(cloud.points.areas, "an area");
}

bool has_own_properties(const Columns& columns) {
    return columns.has(normal_names) && columns.has(albedo_names) &&
           columns.has({"radius", "area", "face_id", "material_id"});
}

V3d offset_from_text(std::string_view text) {
    TextCursor words(text);
    V3d offset;
    for (int axis = 0; axis < 3; ++axis) offset[axis] = words.number("a coordinate of the offset");
    return offset;
}

LightUnits units_from_text(std::string_view text) {
    const std::string_view name = TextCursor(text).word();
    for (const auto& [known, units] : {std::pair{"compat", LightUnits::compat}, std::pair{"spec", LightUnits::spec},
                                       std::pair{"raw", LightUnits::raw}})
        if (name == known) return units;
    throw BrokenContent("the header has light_units " + quoted(name) + ", expected compat, spec or raw");
}

/// What the comments of our own files say: see the writer's header.
void read_own_comments(const PlyHeader& header, PointFile& points, UpAxis& up) {
    for (const std::string& comment : header.comments) {
        TextCursor words(comment);
        const std::string_view key = words.word_on_line();
        const std::string_view value = words.rest_of_line();
        if (key == "up")
            up = value == "y" ? UpAxis::y : UpAxis::z;
        else if (key == "offset")
            points.cloud.points.origin = offset_from_text(value);
        else if (key == "light_units")
            points.light_units = units_from_text(value);
        else if (key == "exposure")
            points.exposure = TextCursor(value).number("an exposure");
        else if (key == "source")
            points.source = value;
    }
}

bool names_us(const PlyHeader& header) {
    return std::any_of(header.comments.begin(), header.comments.end(),
                       [](const std::string& comment) { return comment.starts_with("vmap "); });
}

}  // namespace

void read_ply_vertices(const PlyHeader& header, const PlyElement& vertex, PlyElements& elements, MeshFile& file) {
    Columns columns(vertex);
    if (!columns.has(position_names)) throw BrokenContent("the element 'vertex' has no properties x, y and z");
    elements.expect_to_fit(vertex);

    PolygonSoup& soup = file.soup;
    std::vector<V3d> exact_positions;
    const bool floats = std::all_of(position_names.begin(), position_names.end(),
                                    [&](const char* name) { return fits_float(columns.type(name)); });
    if (floats)
        columns.add(position_names, soup.positions.offsets);
    else
        columns.add(position_names, exact_positions);
    if (columns.has(normal_names)) columns.add(normal_names, soup.normals);

    const bool lit_points = columns.has(albedo_names) || columns.has(irradiance_names);
    if (lit_points) file.points = add_point_columns(columns);
    const Names* colors = std::find_if(std::begin(color_names), std::end(color_names),
                                       [&](const Names& names) { return columns.has(names); });
    // Beside an albedo the colours are for display only.
    if (colors != std::end(color_names) && !columns.has(albedo_names)) columns.add(*colors, soup.colors);
    const auto* texcoords = std::find_if(std::begin(texcoord_names), std::end(texcoord_names),
                                         [&](const auto& names) { return columns.has({names[0], names[1]}); });
    if (texcoords != std::end(texcoord_names)) columns.add(*texcoords, soup.texcoords);
    columns.read(elements);

    expect_usable(soup.positions.offsets);
    expect_usable(exact_positions);
    if (!floats) soup.positions = frame_positions(exact_positions);
    if (!soup.colors.empty()) decode_ply_colors(columns.type((*colors)[0]), soup.colors);
    for (Imath::V2f& texcoord : soup.texcoords) texcoord.y = 1 - texcoord.y;
    if (!lit_points) return;

    file.points->ours = names_us(header) && has_own_properties(columns);
    if (file.points->ours) read_own_comments(header, *file.points, file.up);
    expect_finite(file.points->cloud);
}

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vertex_reader.h"

#include "../content_error.h"
#include "limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string_view>

namespace vmap::gltf {

struct VertexReader::Shape {
    std::uint32_t components = 3;             // read for each vertex
    std::array<std::string_view, 2> types{};  // that the accessor may have
    enum { real, real_or_quantized, real_or_integer, integer } numbers = real;
    bool fractions = false;  // integers stand for fractions even where the file forgets to say so
};

namespace {

using Imath::C4f;
using Imath::M44d;
using Imath::V2f;
using Imath::V3f;

/// The same floats as vectors.
template <class Vector>
std::vector<Vector> as_vectors(const std::vector<float>& values) {
    static_assert(sizeof(Vector) % sizeof(float) == 0);
    std::vector<Vector> vectors(values.size() * sizeof(float) / sizeof(Vector));
    if (!values.empty()) std::memcpy(static_cast<void*>(vectors.data()), values.data(), values.size() * sizeof(float));
    return vectors;
}

/// Marks are cheaper than sorting, unless the vertices are many more than the sequence names.
std::vector<std::uint32_t> distinct(const std::vector<std::uint32_t>& sequence, std::uint64_t count) {
    constexpr std::uint64_t marks_per_index = 64;
    std::vector<std::uint32_t> chosen;
    if (count / marks_per_index > sequence.size()) {
        chosen = sequence;
        std::sort(chosen.begin(), chosen.end());
        chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
        return chosen;
    }
    std::vector<bool> used(count, false);
    for (const std::uint32_t index : sequence) used[index] = true;
    chosen.reserve(static_cast<std::size_t>(std::count(used.begin(), used.end(), true)));
    for (std::uint32_t i = 0; i < count; ++i)
        if (used[i]) chosen.push_back(i);
    return chosen;
}

void renumber(std::vector<std::uint32_t>& sequence, const std::vector<std::uint32_t>& chosen) {
    if (chosen.empty()) return;
    const std::uint64_t span = static_cast<std::uint64_t>(chosen.back()) + 1;
    if (span <= 64 * sequence.size()) {
        std::vector<std::uint32_t> numbers(span, 0);
        for (std::uint32_t i = 0; i < chosen.size(); ++i) numbers[chosen[i]] = i;
        for (std::uint32_t& index : sequence) index = numbers[index];
        return;
    }
    for (std::uint32_t& index : sequence)
        index = static_cast<std::uint32_t>(std::lower_bound(chosen.begin(), chosen.end(), index) - chosen.begin());
}

}  // namespace

VertexReader::VertexReader(const Document& document, const Primitive& primitive, const std::vector<double>& weights,
                           Buffers& buffers)
    : document_(document), primitive_(primitive), weights_(weights), buffers_(buffers) {
    const std::optional<std::size_t> position = find_attribute(primitive.attributes, "POSITION");
    if (!position) return;
    if (primitive.draco) {
        try {
            draco_ = decode_draco(document, primitive, *primitive.draco, buffers);
        } catch (const BrokenContent& error) {
            throw BrokenContent(fmt::format("{}: {}", primitive.where, error.what()));
        }
    }
    count_ = draco_ && draco_->find("POSITION") != nullptr ? draco_->vertex_count : document.accessors[*position].count;
    if (count_ > std::numeric_limits<std::uint32_t>::max())
        throw UnsupportedContent(fmt::format("{} has more vertices than have 32-bit numbers", primitive.where));
    check_counts();
}

std::string VertexReader::place(const std::string& attribute) const {
    return fmt::format("{}.attributes.{}", primitive_.where, attribute);
}

void VertexReader::check_counts() const {
    const auto check = [&](const Attributes& attributes) {
        for (const auto& [name, accessor] : attributes)
            if (document_.accessors[accessor].count != count_)
                throw BrokenContent(fmt::format("{} has {} elements for {} vertices", place(name),
                                                document_.accessors[accessor].count, count_));
    };
    check(primitive_.attributes);
    for (const Attributes& target : primitive_.targets) check(target);
}

void VertexReader::check_shape(const Accessor& accessor, const std::string& name, const Shape& shape) const {
    if (std::find(shape.types.begin(), shape.types.end(), accessor.type) == shape.types.end())
        throw BrokenContent(fmt::format("{} has the type {}, expected {}", place(name), accessor.type, shape.types[0]));
    const bool real = accessor.component == ComponentType::float32;
    const bool small = !real && accessor.component != ComponentType::uint32;
    const bool is_unsigned = accessor.component == ComponentType::uint8 || accessor.component == ComponentType::uint16;
    const bool quantized = small && uses_extension(document_, "KHR_mesh_quantization");
    const auto sound = [&] {
        switch (shape.numbers) {
            case Shape::real:
                return real;
            case Shape::real_or_quantized:
                return real || quantized;
            case Shape::real_or_integer:
                return real || is_unsigned || quantized;
            case Shape::integer:
                break;
        }
        return is_unsigned;
    };
    if (!sound())
        throw BrokenContent(fmt::format("{} has the componentType {}, which it may not have", place(name),
                                        static_cast<int>(accessor.component)));
}

std::optional<Elements> VertexReader::find(const std::string& name, const Shape& shape) {
    const std::optional<std::size_t> accessor = find_attribute(primitive_.attributes, name);
    if (!accessor) return std::nullopt;
    check_shape(document_.accessors[*accessor], name, shape);
    std::optional<Elements> elements;
    if (const Elements* packed = draco_ ? draco_->find(name) : nullptr)
        elements = *packed;
    else
        elements = open_accessor(document_.accessors[*accessor], buffers_);
    if (shape.fractions && elements->component != ComponentType::float32) elements->normalized = true;
    return elements;
}

std::vector<float> VertexReader::read(const std::string& name, const Shape& shape, float missing) {
    const std::optional<Elements> elements = find(name, shape);
    if (!elements) return {};
    buffers_.spend(size(), shape.components * sizeof(float));
    std::vector<float> values(size() * shape.components, missing);
    read_floats(*elements, selection_, shape.components, values);
    add_targets(name, shape, values);
    return values;
}

void VertexReader::add_targets(const std::string& name, const Shape& shape, std::vector<float>& values) {
    for (std::size_t t = 0; t < primitive_.targets.size(); ++t) {
        const std::optional<std::size_t> accessor = find_attribute(primitive_.targets[t], name);
        const auto weight = static_cast<float>(weights_[t]);
        if (!accessor || weight == 0) continue;
        check_shape(document_.accessors[*accessor], name, shape);
        buffers_.spend(values.size(), sizeof(float));
        std::vector<float> offsets(values.size(), 0.0F);
        read_floats(open_accessor(document_.accessors[*accessor], buffers_), selection_, shape.components, offsets);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * offsets[i];
    }
}

void VertexReader::check_finite(const std::string& name, const std::vector<float>& values) const {
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
        throw BrokenContent(fmt::format("{} has a value that is not finite", place(name)));
}

std::vector<std::uint32_t> VertexReader::sequence() {
    if (draco_) return draco_->indices;
    std::vector<std::uint32_t> sequence;
    if (!primitive_.indices) {
        buffers_.spend(count_, sizeof(std::uint32_t));
        sequence.resize(count_);
        std::iota(sequence.begin(), sequence.end(), 0U);
        return sequence;
    }
    const Accessor& accessor = document_.accessors[*primitive_.indices];
    const bool is_unsigned = accessor.component == ComponentType::uint8 ||
                             accessor.component == ComponentType::uint16 || accessor.component == ComponentType::uint32;
    if (accessor.type != "SCALAR" || !is_unsigned)
        throw BrokenContent(primitive_.where + ".indices are not unsigned scalars");
    sequence = read_integers(open_accessor(accessor, buffers_), buffers_);
    const std::uint64_t restart = (1ULL << 8U * byte_size(accessor.component)) - 1;
    for (const std::uint32_t index : sequence)
        if (index >= count_ || index == restart)
            throw BrokenContent(fmt::format("{}.indices name vertex {} of {}", primitive_.where, index, count_));
    return sequence;
}

void VertexReader::keep_used(std::vector<std::uint32_t>& sequence) {
    std::vector<std::uint32_t> chosen = distinct(sequence, count_);
    if (chosen.size() == count_) return;
    renumber(sequence, chosen);
    selection_ = {.all = false, .chosen = std::move(chosen)};
}

std::vector<V3f> VertexReader::positions() {
    const std::vector<float> values =
        read("POSITION", {.components = 3, .types = {"VEC3"}, .numbers = Shape::real_or_quantized}, 0);
    check_finite("POSITION", values);
    return as_vectors<V3f>(values);
}

std::vector<V3f> VertexReader::vectors(const std::string& name) {
    const std::vector<float> values = read(name, {.components = 3, .types = {"VEC3"}, .numbers = Shape::real}, 0);
    check_finite(name, values);
    return as_vectors<V3f>(values);
}

std::vector<V3f> VertexReader::normals() {
    return as_vectors<V3f>(
        read("NORMAL", {.components = 3, .types = {"VEC3"}, .numbers = Shape::real_or_quantized}, 0));
}

std::vector<V2f> VertexReader::texcoords(std::size_t set) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    const std::vector<float> values =
        read(name, {.components = 2, .types = {"VEC2"}, .numbers = Shape::real_or_integer}, 0);
    check_finite(name, values);
    const auto too_large = [](float value) { return std::abs(value) > largest_texture_coordinate; };
    if (std::any_of(values.begin(), values.end(), too_large))
        throw UnsupportedContent(fmt::format("{} exceeds {:.0e}", place(name), largest_texture_coordinate));
    return as_vectors<V2f>(values);
}

std::vector<C4f> VertexReader::colors() {
    const std::vector<float> values =
        read("COLOR_0",
             {.components = 4, .types = {"VEC4", "VEC3"}, .numbers = Shape::real_or_integer, .fractions = true}, 1);
    check_finite("COLOR_0", values);
    if (std::any_of(values.begin(), values.end(), [](float value) { return value < 0; }))
        throw BrokenContent(place("COLOR_0") + " has a negative value");
    return as_vectors<C4f>(values);
}

std::vector<M44d> VertexReader::blend(const std::vector<M44d>& joints) {
    buffers_.spend(size(), sizeof(M44d) + sizeof(double));
    std::vector<M44d> blended(size(), M44d(0.0));
    std::vector<double> sums(size(), 0.0);
    for (int set = 0; find_attribute(primitive_.attributes, fmt::format("JOINTS_{}", set)); ++set) {
        const std::string joints_name = fmt::format("JOINTS_{}", set);
        const std::string weights_name = fmt::format("WEIGHTS_{}", set);
        const auto numbers = read(joints_name, {.components = 4, .types = {"VEC4"}, .numbers = Shape::integer}, 0);
        const auto weights =
            read(weights_name,
                 {.components = 4, .types = {"VEC4"}, .numbers = Shape::real_or_integer, .fractions = true}, 0);
        if (weights.empty()) throw BrokenContent(place(joints_name) + " comes without weights");
        check_finite(weights_name, weights);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto joint = static_cast<std::size_t>(numbers[i]);
            if (joint >= joints.size())
                throw BrokenContent(fmt::format("{} names joint {} of {}", place(joints_name), joint, joints.size()));
            const double weight = weights[i];
            if (weight == 0) continue;
            blended[i / 4] += M44d(joints[joint]) * weight;
            sums[i / 4] += weight;
        }
    }
    for (std::size_t i = 0; i < blended.size(); ++i) {
        if (sums[i] > 0)
            blended[i] *= 1 / sums[i];
        else
            blended[i] = M44d();
    }
    return blended;
}

}  // namespace vmap::gltf

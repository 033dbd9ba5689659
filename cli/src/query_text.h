// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Questions to a visibility map as text, one per line.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vmap {

/// A point by its index, or the one next to a place; with a radius all points around it.
struct PointSpec {
    std::variant<std::uint32_t, Imath::V3d> where;
    std::optional<double> radius;  ///< world units
};

enum class QuestionKind { sees, groups, ray, umbra };

struct Question {
    QuestionKind kind = QuestionKind::sees;
    std::vector<PointSpec> points;  ///< two of sees and groups, one of umbra
    Imath::V3d from{0, 0, 0};       ///< of a ray
    Imath::V3d direction{0, 0, 1};
    std::string text;  ///< as it was asked
};

/// A question from its words: "sees A B", "groups A:R B:R", "ray X,Y,Z DX,DY,DZ" or "umbra A".
///
/// - where: names the line or option in messages
/// - throws UsageError for anything else
[[nodiscard]] Question parse_question(std::string_view where, const std::vector<std::string>& words);

/// Questions of a file, one per line; empty lines and lines that begin with # are skipped. The name - is standard
/// input.
///
/// - kind: first word of every line, for files whose lines have none; else empty
/// - throws FileError for a file that cannot be read or has a line that is no question
[[nodiscard]] std::vector<Question> read_questions(const std::string& file, const std::string& kind = {});

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The values behind the header of a PLY file, read element by element.
#pragma once

#include "ply_header.h"
#include "text_cursor.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace vmap {

/// Where the values of a property that is no list go: value i to first[i * stride].
struct PlyColumn {
    std::size_t property = 0;  ///< place among the element's properties
    std::variant<float*, double*, std::uint32_t*> first;
    std::size_t stride = 1;
};

/// Who takes the values of a list property, one call for each element.
struct PlyList {
    std::size_t property = 0;
    std::function<void(std::span<const std::int64_t>)> take;  ///< the values are whole numbers
};

/// Reads the elements in the order of the file: each is either read or skipped, none left out.
/// Nothing is allocated by the numbers of the file before fits() has compared them with its size.
class PlyElements {
public:
    /// - text: of the whole file; header: of the same file; both must outlive this
    PlyElements(const PlyHeader& header, std::string_view text);

    /// - throws BrokenContent when the rest of the file cannot hold as many elements as the header says
    void expect_to_fit(const PlyElement& element) const;

    /// - columns: of properties that are no lists; lists: of properties that are; others are passed over
    /// - throws BrokenContent for a value that is not of its type, a number that is not finite, and a file that ends
    /// early
    void read(const PlyElement& element, std::span<const PlyColumn> columns, std::span<const PlyList> lists = {});

    void skip(const PlyElement& element) { read(element, {}); }

    /// Bytes behind the last element that was read, without white space in a text file.
    [[nodiscard]] std::size_t left_over();

private:
    PlyEncoding encoding_;
    TextCursor words_;        ///< of a text file
    std::string_view bytes_;  ///< of a binary one
};

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// POV-Ray's scene language: numbers without a locale, vectors, and a buffer before the file.
#pragma once

#include <vmap/exporters/file_writer.h>

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>
#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace vmap {

[[nodiscard]] std::string pov_vector(const Imath::V3d& v);

/// "rgb <r, g, b>"
[[nodiscard]] std::string pov_color(const Imath::C3f& color);

/// "matrix <...>" of an affine transform of row vectors, which is POV-Ray's order too.
[[nodiscard]] std::string pov_matrix(const Imath::M44d& m);

/// Collects text and hands it to a file in large pieces. Call flush() at the end.
class PovText {
public:
    explicit PovText(FileWriter& file) : file_(file) {}

    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        if (buffer_.size() > piece) flush();
    }
    template <class... Values>
    void line(fmt::format_string<Values...> format, Values&&... values) {
        add(format, std::forward<Values>(values)...);
        buffer_.push_back('\n');
    }

    /// One element of a list, with the comma that all but the last have.
    void end_element(bool last) {
        const std::string_view end = last ? "\n" : ",\n";
        buffer_.append(end.begin(), end.end());
    }

    void flush() {
        file_.write(buffer_.data(), buffer_.size());
        buffer_.clear();
    }

private:
    static constexpr std::size_t piece = std::size_t{1} << 18;
    FileWriter& file_;
    fmt::memory_buffer buffer_;
};

}  // namespace vmap

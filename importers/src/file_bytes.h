// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whole files in memory, without the surprises of special files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace vmap {

/// An owned block of bytes; cheaper than a vector because it is not filled with zeros first.
class Bytes {
public:
    Bytes() = default;
    explicit Bytes(std::size_t size) : data_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}

    [[nodiscard]] std::byte* data() { return data_.get(); }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::span<const std::byte> span() const { return {data_.get(), size_}; }

private:
    std::unique_ptr<std::byte[]> data_;
    std::size_t size_ = 0;
};

/// The same bytes as text.
[[nodiscard]] std::string_view as_text(std::span<const std::byte> bytes);

/// Reads a regular file. Pipes, devices and folders are refused without waiting for them.
///
/// - limit: largest size in bytes that is read
/// - throws BrokenContent with what the system or the check found; the message does not name the file
[[nodiscard]] Bytes read_file(const std::filesystem::path& path, std::uint64_t limit);

/// Reads the first bytes of a regular file that has at least that many.
///
/// - throws BrokenContent as read_file does, and for a file that is shorter
[[nodiscard]] Bytes read_file_start(const std::filesystem::path& path, std::uint64_t length);

/// The start of a regular file and its size.
struct FileHead {
    Bytes bytes;
    std::uint64_t size = 0;  ///< of the whole file
};

/// - most: bytes to read; a shorter file is read as a whole
/// - throws BrokenContent as read_file does
[[nodiscard]] FileHead read_file_head(const std::filesystem::path& path, std::uint64_t most);

}  // namespace vmap

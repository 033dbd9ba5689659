// SPDX-License-Identifier: Apache-2.0
#include "check_tree.h"
#include "checksum.h"
#include "vmap_chunks.h"
#include "vmap_layout.h"

#include <vmap/error.h>
#include <vmap/printable.h>

#include <algorithm>
#include <fstream>
#include <system_error>

namespace vmap {
namespace {

/// What is wrong with a file; the reader adds its name.
struct Broken {
    std::string what;
};

/// The payload of one chunk. Every read is checked against what is left of it before memory is taken.
class InputArchive {
public:
    static constexpr bool reads = true;

    InputArchive(std::istream& file, const ChunkHeader& header)
        : file_(file), name_(printable({header.name.data(), header.name.size()})), left_(header.size) {
        checksum_.add(std::as_bytes(std::span(&header, 1)));
    }

    template <class T>
    void value(T& v) {
        static_assert(std::is_standard_layout_v<T>);
        read(std::as_writable_bytes(std::span(&v, 1)));
    }
    template <class T>
    void array(T& values) {
        values.resize(count(sizeof(values[0])));
        read(std::as_writable_bytes(std::span(values)));
    }
    template <class T, class One>
    void list(std::vector<T>& values, const One& one) {
        // No entry takes less: the count cannot ask for much more memory than the file is long.
        const std::size_t entries = count(64);
        for (std::size_t i = 0; i < entries; ++i) one(values.emplace_back());
    }
    template <class Enum>
    Enum checked_enum(std::uint32_t number, Enum last) const {
        if (number > static_cast<std::uint32_t>(last))
            throw Broken{"chunk " + name_ + " has an unknown kind " + std::to_string(number)};
        return static_cast<Enum>(number);
    }

    void require(bool sound) const {
        if (!sound) throw Broken{"chunk " + name_ + " is inconsistent"};
    }

    void rest(std::vector<std::byte>& bytes) {
        bytes.resize(left_);
        read(bytes);
    }

    /// Everything was read and is as it was written.
    void finish() {
        if (left_ != 0) throw Broken{"chunk " + name_ + " is " + std::to_string(left_) + " bytes too long"};
        std::uint64_t written = 0;
        file_.read(reinterpret_cast<char*>(&written), sizeof(written));
        if (!file_ || written != checksum_.value())
            throw Broken{"chunk " + name_ + " does not match its checksum; the file was changed"};
    }

private:
    std::size_t count(std::size_t entry_size) {
        std::uint64_t n = 0;
        value(n);
        if (n > left_ / entry_size)
            throw Broken{"chunk " + name_ + " has a count of " + std::to_string(n) + ", more than it has room for"};
        return n;
    }

    void read(std::span<std::byte> bytes) {
        if (bytes.size() > left_) throw Broken{"chunk " + name_ + " is too short"};
        file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        if (!file_) throw Broken{"chunk " + name_ + " cannot be read"};
        checksum_.add(bytes);
        left_ -= bytes.size();
    }

    std::istream& file_;
    std::string name_;
    std::uint64_t left_;
    Checksum checksum_;
};

FileHeader read_header(std::istream& file, std::uint64_t file_size) {
    FileHeader header;
    const FileHeader expected;
    if (file_size < sizeof(header)) throw Broken{"is too short for a .vmap file"};
    file.read(reinterpret_cast<char*>(&header), sizeof(header));
    if (!file || header.magic != expected.magic) throw Broken{"is not a .vmap file"};
    if (header.version != vmap_file_version)
        throw Broken{"has version " + std::to_string(header.version) + "; expected " +
                     std::to_string(vmap_file_version)};
    if (header.checksum != checksum_of(header)) throw Broken{"has a header that was changed"};
    if (header.file_size != file_size)
        throw Broken{"has " + std::to_string(file_size) + " bytes; expected " + std::to_string(header.file_size)};
    return header;
}

ChunkHeader read_chunk_header(std::istream& file, std::uint64_t left) {
    ChunkHeader header{};
    if (left < sizeof(header) + sizeof(std::uint64_t)) throw Broken{"ends where a chunk should begin"};
    file.read(reinterpret_cast<char*>(&header), sizeof(header));
    if (!file || header.size > left - sizeof(header) - sizeof(std::uint64_t))
        throw Broken{"has a chunk that is larger than the file"};
    return header;
}

void check(const VmapContents& c) {
    const std::size_t points = c.cloud.size();
    const auto has_size = [&](const auto& array) { return array.empty() || array.size() == points; };
    if (c.cloud.normals.size() != points || !has_size(c.cloud.areas) || !has_size(c.cloud.albedo) ||
        !has_size(c.cloud.emission) || !has_size(c.cloud.faces) || !has_size(c.cloud.materials))
        throw Broken{"has points without all their attributes"};
    if (const std::string fault = fault_of(c.tree, points); !fault.empty()) throw Broken{"is inconsistent: " + fault};
    if (const std::string fault = fault_of(c.map, c.tree); !fault.empty()) throw Broken{"is inconsistent: " + fault};
    if (c.map.rule != VisibilityRule::patch) return;
    if (const std::string fault = fault_of(c.patches, c.tree); !fault.empty())
        throw Broken{"is inconsistent: " + fault};
}

VmapContents read_contents(std::istream& file, std::uint64_t file_size) {
    const FileHeader header = read_header(file, file_size);
    VmapContents contents;
    std::vector<std::string> found;
    std::uint64_t left = file_size - sizeof(header);
    for (std::uint32_t i = 0; i < header.chunks; ++i) {
        const ChunkHeader chunk = read_chunk_header(file, left);
        left -= sizeof(chunk) + chunk.size + sizeof(std::uint64_t);
        const std::string name(chunk.name.data(), chunk.name.size());
        if (std::ranges::find(found, name) != found.end()) throw Broken{"has chunk " + printable(name) + " twice"};
        found.push_back(name);
        InputArchive archive(file, chunk);
        bool known = false;
        for_each_chunk([&](const std::string& own, const auto& describe) {
            if (own != name) return;
            describe(archive, contents);
            known = true;
        });
        if (!known) archive.rest(contents.extra[name]);
        archive.finish();
    }
    if (left != 0) throw Broken{"goes on after its last chunk"};
    for_each_chunk([&](const std::string& own, const auto&) {
        if (std::ranges::find(found, own) == found.end()) throw Broken{"lacks chunk " + own};
    });
    check(contents);
    contents.patches.point_order = contents.tree.point_order;
    return contents;
}

}  // namespace

VmapContents read_vmap(const std::filesystem::path& file) {
    const std::string name = printable(file.string());
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw FileError(name + ": " + (error ? error.message() : "is not a regular file; expected a .vmap file"));
    const std::uint64_t size = std::filesystem::file_size(file, error);
    std::ifstream stream(file, std::ios::binary);
    if (error || !stream) throw FileError(name + ": cannot be opened");
    try {
        return read_contents(stream, size);
    } catch (const Broken& broken) {
        throw FileError(name + ": " + broken.what);
    }
}

void require_same_points(const VmapContents& contents, const PointCloud& cloud, const std::string& cloud_name) {
    if (contents.cloud.size() != cloud.size())
        throw UnsupportedInput(printable(cloud_name) + ": has " + std::to_string(cloud.size()) +
                               " points; the visibility map is of " + std::to_string(contents.cloud.size()));
    if (contents.cloud.origin != cloud.origin || contents.cloud.positions != cloud.positions ||
        contents.cloud.normals != cloud.normals)
        throw UnsupportedInput(printable(cloud_name) + ": its points are not those of the visibility map");
}

}  // namespace vmap

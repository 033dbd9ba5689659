// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_bytes.h"

#include "content_error.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

namespace vmap {
namespace {

[[noreturn]] void fail(std::string_view step, int error) {
    throw BrokenContent(fmt::format("{}: {}", step, std::generic_category().message(error)));
}

/// A regular file that is open for reading.
class OpenFile {
public:
    // Without O_NONBLOCK opening a pipe would wait for its writer.
    explicit OpenFile(const std::filesystem::path& path)
        : fd_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
        if (fd_ < 0) fail("cannot open", errno);
    }
    ~OpenFile() { ::close(fd_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] std::uint64_t size() const {
        struct stat status{};
        if (::fstat(fd_, &status) != 0) fail("cannot examine", errno);
        if (S_ISDIR(status.st_mode)) throw BrokenContent("is a folder, expected a file");
        if (!S_ISREG(status.st_mode)) throw BrokenContent("is not a regular file");
        return static_cast<std::uint64_t>(status.st_size);
    }

    [[nodiscard]] Bytes read(std::uint64_t length) const {
        Bytes bytes(length);
        for (std::size_t done = 0; done < length;) {
            constexpr std::size_t largest_read = 1U << 30U;
            const ::ssize_t got = ::read(fd_, bytes.data() + done, std::min<std::size_t>(length - done, largest_read));
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) fail("cannot read", errno);
            if (got == 0) throw BrokenContent("became shorter while it was read");
            done += static_cast<std::size_t>(got);
        }
        return bytes;
    }

private:
    int fd_;
};

}  // namespace

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Bytes read_file(const std::filesystem::path& path, std::uint64_t limit) {
    const OpenFile file(path);
    const std::uint64_t size = file.size();
    if (size > limit) throw BrokenContent(fmt::format("has {} bytes, more than the {} that are read", size, limit));
    return file.read(size);
}

Bytes read_file_start(const std::filesystem::path& path, std::uint64_t length) {
    const OpenFile file(path);
    const std::uint64_t size = file.size();
    if (size < length) throw BrokenContent(fmt::format("has {} bytes, expected at least {}", size, length));
    return file.read(length);
}

FileHead read_file_head(const std::filesystem::path& path, std::uint64_t most) {
    const OpenFile file(path);
    const std::uint64_t size = file.size();
    return {file.read(std::min(size, most)), size};
}

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <vmap/error.h>
#include <vmap/exporters/file_writer.h>
#include <vmap/printable.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <streambuf>
#include <system_error>
#include <utility>
#include <vector>

namespace vmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& action, int error) {
    throw FileError(printable(path) + ": cannot " + action + ": " + std::generic_category().message(error));
}

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }

    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] bool is_open() const { return fd_ >= 0; }

    /// Returns 0 or the error; some file systems report a full disk only here.
    int close() {
        const int fd = std::exchange(fd_, -1);
        return fd >= 0 && ::close(fd) != 0 && errno != EINTR ? errno : 0;
    }

private:
    int fd_;
};

/// Buffers writes to a descriptor and throws when one fails, from then on at every use.
class DescriptorBuffer : public std::streambuf {
public:
    DescriptorBuffer(const std::string& path, int fd, bool seekable) : path_(path), fd_(fd), seekable_(seekable) {
        reset_buffer();
    }

    void flush() {
        write_out(pbase(), static_cast<std::size_t>(pptr() - pbase()));
        reset_buffer();
    }

protected:
    int_type overflow(int_type c) override {
        flush();
        if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
        return traits_type::not_eof(c);
    }

    std::streamsize xsputn(const char* data, std::streamsize size) override {
        const auto count = static_cast<std::size_t>(size);
        if (size > epptr() - pptr()) flush();
        if (count >= buffer_.size()) {
            write_out(data, count);
        } else {
            std::memcpy(pptr(), data, count);
            pbump(static_cast<int>(size));
        }
        return size;
    }

    int sync() override {
        flush();
        return 0;
    }

    pos_type seekoff(off_type offset, std::ios_base::seekdir direction, std::ios_base::openmode) override {
        if (direction == std::ios_base::cur && offset == 0) return position_ + (pptr() - pbase());
        if (!seekable_) return pos_type(off_type(-1));
        flush();
        const int whence = direction == std::ios_base::beg   ? SEEK_SET
                           : direction == std::ios_base::cur ? SEEK_CUR
                                                             : SEEK_END;
        const off_t reached = ::lseek(fd_, offset, whence);
        if (reached < 0) return pos_type(off_type(-1));
        position_ = reached;
        return position_;
    }

    pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
        return seekoff(position, std::ios_base::beg, mode);
    }

private:
    void reset_buffer() { setp(buffer_.data(), buffer_.data() + buffer_.size()); }

    void write_out(const char* data, std::size_t size) {
        if (error_ != 0) fail(path_, "write", error_);
        while (size > 0) {
            const ssize_t written = ::write(fd_, data, size);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) {
                error_ = written < 0 ? errno : EIO;
                fail(path_, "write", error_);
            }
            data += written;
            size -= static_cast<std::size_t>(written);
            position_ += written;
        }
    }

    static constexpr std::size_t buffer_size = std::size_t{1} << 18;

    const std::string& path_;
    int fd_;
    bool seekable_;
    off_t position_ = 0;
    int error_ = 0;
    std::vector<char> buffer_ = std::vector<char>(buffer_size);
};

/// The file that a chain of symbolic links ends at, which need not exist.
fs::path resolve_links(fs::path path) {
    std::error_code error;
    for (int depth = 0; depth < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++depth) {
        const fs::path next = fs::read_symlink(path, error);
        if (error) break;
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return path;
}

/// Calls attempt(name) with names in the folder until one is free; returns that name.
template <class Attempt>
std::string with_free_name(const std::string& folder, Attempt attempt) {
    for (int i = 0;; ++i) {
        std::string name = folder;
        name.append("/.vmap-").append(std::to_string(::getpid())).append("-").append(std::to_string(i)).append(".tmp");
        if (attempt(name) || errno != EEXIST || i == 10000) return name;
    }
}

}  // namespace

class FileWriter::Impl {
public:
    Impl(std::string path, Durability durability) : path_(std::move(path)), durability_(durability) {
        open();
        buffer_.emplace(path_, file_.get(), !direct_);
        stream_.rdbuf(&*buffer_);
        stream_.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    }

    ~Impl() { remove_temporary(); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] bool seekable() const { return !direct_; }
    [[nodiscard]] std::ostream& stream() { return stream_; }

    void finish() {
        if (finished_) return;
        if (buffer_) buffer_->flush();
        if (durability_ == Durability::synced && !direct_ && ::fsync(file_.get()) != 0) fail(path_, "sync", errno);
        finished_ = true;
    }

    void commit() {
        finish();
        if (committed_) return;
        // Named only now: a process that ends between finish() and commit() leaves nothing.
        if (!direct_ && temporary_.empty()) name_temporary();
        if (const int error = file_.close(); error != 0) fail(path_, "close", error);
        committed_ = true;
        if (direct_) return;
        if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, "rename the finished file", errno);
        temporary_.clear();
        if (durability_ == Durability::synced) sync_folder();
    }

private:
    void open() {
        if (path_ == "-") {
            direct_ = true;
            file_ = Descriptor(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3));
            if (!file_.is_open()) fail("standard output", "open", errno);
            return;
        }
        target_ = resolve_links(path_);
        folder_ = fs::path(target_).parent_path().string();
        if (folder_.empty()) folder_ = ".";

        struct stat status{};
        const bool exists = ::stat(target_.c_str(), &status) == 0;
        if (exists && S_ISDIR(status.st_mode)) fail(path_, "write", EISDIR);
        if (exists && ::access(target_.c_str(), W_OK) != 0) fail(path_, "write", errno);
        direct_ = exists && !S_ISREG(status.st_mode);
        if (direct_) {
            file_ = Descriptor(::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
            if (!file_.is_open()) fail(path_, "open", errno);
        } else {
            if (fs::path(target_).filename().empty()) fail(path_, "write", EISDIR);
            open_temporary();
            // The new file is as private as the old one.
            if (exists && ::fchmod(file_.get(), status.st_mode & 07777) != 0) fail(path_, "set the mode", errno);
        }
    }

    /// An unnamed file vanishes even when the process is killed; where the file system has none, a named one is used.
    void open_temporary() {
        constexpr int mode = 0666;  // cut down by the user's mask
        if (::access("/proc/self/fd", X_OK) == 0)
            file_ = Descriptor(::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
        if (file_.is_open()) return;

        const std::string name = with_free_name(folder_, [&](const std::string& candidate) {
            file_ = Descriptor(::open(candidate.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode));
            return file_.is_open();
        });
        if (!file_.is_open()) fail(path_, "create", errno);
        temporary_ = name;
    }

    /// Gives the unnamed file a name, from which it can be renamed over an old file.
    void name_temporary() {
        const std::string unnamed = "/proc/self/fd/" + std::to_string(file_.get());
        bool linked = false;
        const std::string name = with_free_name(folder_, [&](const std::string& candidate) {
            linked = ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, candidate.c_str(), AT_SYMLINK_FOLLOW) == 0;
            return linked;
        });
        if (!linked) fail(path_, "create", errno);
        temporary_ = name;
    }

    void sync_folder() const {
        const Descriptor folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (!folder.is_open()) return;  // a folder may be writable and yet not readable
        if (::fsync(folder.get()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(path_, "sync the folder", errno);
    }

    void remove_temporary() noexcept {
        if (!temporary_.empty()) ::unlink(temporary_.c_str());
        temporary_.clear();
    }

    std::string path_;
    Durability durability_;
    std::string target_;     ///< path_ with symbolic links followed
    std::string folder_;     ///< of target_
    std::string temporary_;  ///< empty while the file has no name
    bool direct_ = false;    ///< written in place: standard output, devices, pipes
    bool finished_ = false;
    bool committed_ = false;
    Descriptor file_;
    std::optional<DescriptorBuffer> buffer_;
    std::ostream stream_{nullptr};
};

FileWriter::FileWriter(std::string path, Durability durability)
    : impl_(std::make_unique<Impl>(std::move(path), durability)) {}
FileWriter::~FileWriter() = default;
FileWriter::FileWriter(FileWriter&&) noexcept = default;
FileWriter& FileWriter::operator=(FileWriter&&) noexcept = default;

const std::string& FileWriter::path() const {
    return impl_->path();
}
bool FileWriter::seekable() const {
    return impl_->seekable();
}
std::ostream& FileWriter::stream() {
    return impl_->stream();
}
void FileWriter::write(const void* data, std::size_t size) {
    impl_->stream().write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}
void FileWriter::finish() {
    impl_->finish();
}
void FileWriter::commit() {
    impl_->commit();
}

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The one way in which the toolkit writes files: a file appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <memory>
#include <ostream>
#include <string>

namespace vmap {

/// Whether a file must survive a power cut once it is committed.
enum class Durability {
    synced,  ///< file and folder reach the disk before commit() returns
    fast     ///< left to the operating system; for benchmarks
};

/// Writes to an unnamed or temporary file in the folder of its target and renames it at the end. Until then, and when
/// the writer is destroyed without commit(), the target stays as it was and nothing is left behind.
///
/// The path "-" is standard output. Devices and pipes are written to directly. A symbolic link is followed.
/// Every failure is a FileError that names the path and the system's reason.
class FileWriter {
public:
    explicit FileWriter(std::string path, Durability durability = Durability::synced);
    ~FileWriter();
    FileWriter(FileWriter&&) noexcept;
    FileWriter& operator=(FileWriter&&) noexcept;

    [[nodiscard]] const std::string& path() const;

    /// False for standard output, devices and pipes: seekp fails there.
    [[nodiscard]] bool seekable() const;

    /// Buffered; an operation that fails throws.
    [[nodiscard]] std::ostream& stream();

    void write(const void* data, std::size_t size);

    /// Flushes and syncs without touching the target, so that several files can appear together.
    void finish();

    /// Finishes if need be and puts the file under its name.
    void commit();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vmap

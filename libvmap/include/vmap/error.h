// SPDX-License-Identifier: Apache-2.0
/// \file
/// The ways in which a job can fail. Each carries the exit code that the program documents; its text is one line that
/// names the file or option, what was found and what was expected.
#pragma once

#include <stdexcept>
#include <string>

namespace vmap {

enum class ExitCode {
    ok = 0,
    run_error = 1,
    usage = 2,
    unsupported_input = 3,
    file_error = 4,
    comparison_failed = 5,
    interrupted = 130,
    terminated = 143,
};

/// Base of every error that the toolkit throws on purpose.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// A file that cannot be opened, read or written, or whose content is broken.
class FileError : public Error {
public:
    explicit FileError(const std::string& message) : Error(ExitCode::file_error, message) {}
};

/// A file that is sound but asks for something the toolkit does not do, or a scene without what the job needs.
class UnsupportedInput : public Error {
public:
    explicit UnsupportedInput(const std::string& message) : Error(ExitCode::unsupported_input, message) {}
};

/// An option or a configuration that makes no sense.
class UsageError : public Error {
public:
    explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

}  // namespace vmap

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The program: picks the sub-command, runs it, and turns every failure into one line and a documented exit code.
#include "commands.h"

#include <vmap/error.h>
#include <vmap/printable.h>
#include <vmap/version.h>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <optional>
#include <vector>

namespace vmap {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 done, 1 run error or out of memory, 2 usage, 3 unsupported input, 4 file error,\n"
    "5 comparison failed, 130 interrupted, 143 terminated.\n"
    "vmap COMMAND --help tells about each command and has an example.";

int fail(ExitCode code, const std::string& message) {
    fmt::print(stderr, "vmap: error: {}\n", printable(message));
    return static_cast<int>(code);
}

int run(const Command& command, const CommonOptions& options, Interruption& interruption) {
    std::optional<tbb::global_control> limit;
    if (options.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
    try {
        Job job(options, interruption);
        command.run(job);
        return static_cast<int>(ExitCode::ok);
    } catch (const Interrupted& stop) {
        return 128 + stop.signal();
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::run_error, "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::run_error, error.what());
    }
}

/// A word where a command should stand; the parser itself would only say that one is required.
std::optional<std::string> unknown_command(const CLI::App& program, int argc, const char* const* argv) {
    if (argc < 2 || *argv[1] == '-') return {};
    std::string names;
    for (const CLI::App* app : program.get_subcommands([](const CLI::App*) { return true; })) {
        if (app->get_name() == argv[1]) return {};
        names += (names.empty() ? "" : ", ") + app->get_name();
    }
    return fmt::format("'{}' is not a command; expected one of {}", argv[1], names);
}

int main_of(int argc, const char* const* argv) {
    CLI::App program{"Lights scenes as oriented points through a visibility map."};
    program.set_version_flag("--version", std::string("vmap ") + version);
    program.require_subcommand(1);
    program.footer(exit_codes);

    CommonOptions options;
    const std::vector<Command> commands{add_light_command(program),  add_sample_command(program),
                                        add_info_command(program),   add_build_command(program),
                                        add_query_command(program),  add_render_command(program),
                                        add_export_command(program), add_compare_command(program)};
    for (const Command& command : commands) add_common_options(*command.app, options);

    if (const auto message = unknown_command(program, argc, argv)) return fail(ExitCode::usage, *message);
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return program.exit(success);
    } catch (const CLI::ParseError& error) {
        return fail(ExitCode::usage, std::string(error.what()) + " (vmap --help tells more)");
    }

    Interruption interruption;
    for (const Command& command : commands)
        if (command.app->parsed()) return run(command, options, interruption);
    return fail(ExitCode::usage, "expected a command (vmap --help lists them)");
}

}  // namespace
}  // namespace vmap

int main(int argc, char** argv) try {
    std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away is a write error like any other
    return vmap::main_of(argc, argv);
} catch (...) {
    std::fputs("vmap: error: out of memory\n", stderr);
    return 1;
}

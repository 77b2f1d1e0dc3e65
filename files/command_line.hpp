// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "files/input_error.hpp"

namespace files {

/// The frame of every program's main: options, then `run`, and one line on stderr for whatever goes wrong. Unusable
/// options and input give exit status kExitBadInput; our own failures `failed`, for programs in which 1 is an answer.
template <class Run>
int runMain(CLI::App& app, int argc, char** argv, Run run, int failed = 1) {
    // For --help: host::answersVersion() has answered it already, before anything was started.
    app.add_flag_callback(
        "--version", [] {}, "print version and build, with --json as JSON, and end");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help
        }
        std::fprintf(stderr, "%s: %s; try --help\n", app.get_name().c_str(), error.what());
        return kExitBadInput;
    }
    try {
        return run();
    } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return kExitBadInput;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: failed: %s\n", app.get_name().c_str(), error.what());
        return failed;
    }
}

}  // namespace files

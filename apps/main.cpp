// SPDX-License-Identifier: MIT
// The gnomon command: parse, run one command, end with a sentence and a status.
#include "apps/options.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

int say(int status, const char* sentence) {
    fmt::print(stderr, "gnomon: {}\n", sentence);
    return status;
}

int guarded(int argc, char** argv) {
    try {
        // Standard output carries results only; the log goes to standard error.
        spdlog::set_default_logger(spdlog::stderr_logger_st("gnomon"));
        spdlog::set_pattern("gnomon: %v");
        const auto command = gn::parse_command_line(argc, argv);
        return command ? std::visit([](const auto& options) { return gn::run(options); }, *command) : gn::exit_done;
    } catch (const gn::InputError& error) {
        return say(gn::exit_input, error.what());
    } catch (const gn::Error& error) {
        return say(gn::exit_failed, error.what());
    } catch (const std::bad_alloc&) {
        return say(gn::exit_failed, "out of memory; a smaller --size, resolution or scene needs less");
    } catch (const std::exception& error) {
        return say(gn::exit_failed, error.what());
    } catch (...) {
        return say(gn::exit_failed, "ended by an unknown error");
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int status = guarded(argc, argv);
    // Results that could not be written are no results.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        return say(gn::exit_failed, "standard output could not be written completely");
    }
    return status;
}

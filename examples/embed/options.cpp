// SPDX-License-Identifier: MIT
#include "options.h"

#include <cstdio>
#include <stdexcept>

namespace {

constexpr const char* usage =
    "embed [--output FILE.png] [--visibility] [--draw-casters] [--recipe RECIPE] [--baked FOLDER] [--size WxH] "
    "[--objects N] "
    "[--frames N] [--validate] [--with FEATURE]... [--without FEATURE]...";

std::uint32_t number(const std::string& text, std::uint32_t least, std::uint32_t most) {
    unsigned value = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%u%c", &value, &rest) != 1 || value < least || value > most) {
        throw std::runtime_error("'" + text + "' is no number from " + std::to_string(least) + " to " +
                                 std::to_string(most));
    }
    return value;
}

}  // namespace

Options read_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto next = [&]() -> std::string {
            if (++i == argc) {
                throw std::runtime_error("something must follow " + word + "; " + usage);
            }
            return argv[i];
        };
        if (word == "--output") {
            options.output = next();
        } else if (word == "--visibility") {
            options.visibility = true;
        } else if (word == "--draw-casters") {
            options.draw_casters = true;
        } else if (word == "--recipe") {
            options.recipe = next();
        } else if (word == "--baked") {
            options.baked = next();
        } else if (word == "--size") {
            const std::string size = next();
            const std::size_t cross = size.find('x');
            options.size = {number(size.substr(0, cross), 16, 4096),
                            number(cross == std::string::npos ? "" : size.substr(cross + 1), 16, 4096)};
        } else if (word == "--objects") {
            options.objects = number(next(), 1, 10000);
        } else if (word == "--frames") {
            options.frames = number(next(), 12, 100000);
        } else if (word == "--validate") {
            options.device.validate = true;
        } else if (word == "--with") {
            options.device.with.push_back(next());
        } else if (word == "--without") {
            options.device.without.push_back(next());
        } else {
            throw std::runtime_error("'" + word + "' is not understood; " + usage);
        }
    }
    return options;
}

// SPDX-License-Identifier: MIT
#include "gpu/shader_cache.h"

#include <unistd.h>

#include <fstream>
#include <system_error>

namespace gn {
namespace {

struct Header {
    std::uint32_t magic = 0x56534E47U;  // "GNSV"
    std::uint32_t words = 0;
    std::uint64_t low = 0, high = 0;  ///< fingerprint of the words
};

Header header_of(const std::vector<std::uint32_t>& spirv) {
    const Fingerprint sum = Hasher().bytes(spirv.data(), spirv.size() * 4).finish();
    return {.words = static_cast<std::uint32_t>(spirv.size()), .low = sum.low, .high = sum.high};
}

}  // namespace

ShaderCache::ShaderCache(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code failed;
    if (!folder_.empty() && !std::filesystem::create_directories(folder_, failed) && failed) {
        folder_.clear();
    }
}

std::filesystem::path ShaderCache::file(const Fingerprint& key) const {
    return folder_ / (key.hex() + ".spv");
}

std::vector<std::uint32_t> ShaderCache::load(const Fingerprint& key) const {
    if (folder_.empty()) {
        return {};
    }
    std::error_code failed;
    const auto bytes = std::filesystem::file_size(file(key), failed);
    std::ifstream in(file(key), std::ios::binary);
    Header header;
    if (failed || !in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != Header{}.magic ||
        bytes != sizeof header + std::uintmax_t{header.words} * 4) {
        return {};
    }
    std::vector<std::uint32_t> spirv(header.words);
    if (!in.read(reinterpret_cast<char*>(spirv.data()), static_cast<std::streamsize>(spirv.size() * 4))) {
        return {};
    }
    const Header expected = header_of(spirv);
    return expected.low == header.low && expected.high == header.high ? spirv : std::vector<std::uint32_t>{};
}

void ShaderCache::store(const Fingerprint& key, const std::vector<std::uint32_t>& spirv) const {
    if (folder_.empty()) {
        return;
    }
    const std::filesystem::path final = file(key);
    const std::filesystem::path beside = final.string() + "." + std::to_string(getpid());
    const Header header = header_of(spirv);
    std::error_code ignored;
    {
        std::ofstream out(beside, std::ios::binary);
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        out.write(reinterpret_cast<const char*>(spirv.data()), static_cast<std::streamsize>(spirv.size() * 4));
        out.close();
        if (!out) {
            std::filesystem::remove(beside, ignored);
            return;
        }
    }
    std::filesystem::rename(beside, final, ignored);
}

}  // namespace gn

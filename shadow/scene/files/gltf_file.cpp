// SPDX-License-Identifier: MIT
// Parsing .gltf and .glb with tinygltf, kept inside the model's folder and within bounded memory.
#include "shadow/scene/files/gltf_packed.h"

#include <cstring>

namespace gn::gltf {

namespace {

// What the callbacks of the parser need.
struct Reader {
    Folder folder;
    File* file;
    std::size_t bytes_left = 2 * max_file_bytes;  // of all external files together
};

bool file_exists(const std::string& path, void* user) {
    return static_cast<Reader*>(user)->folder.holds(path);
}

// The parser joins the folder with a name: take it off again, and find the file that the name means; "" where there is none.
std::string expand_path(const std::string& path, void* user) {
    const auto& reader = *static_cast<Reader*>(user);
    std::string folder = reader.folder.root().string();
    folder += folder.ends_with('/') ? "" : "/";
    if (!path.starts_with(folder)) {
        return "";
    }
    const std::string name = path.substr(folder.size());
    try {
        return reader.folder.resolve(name).string();
    } catch (const Error& problem) {
        reader.file->refusals[name] = problem.what();
        return "";
    }
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
    auto& reader = *static_cast<Reader*>(user);
    try {
        if (!reader.folder.holds(path)) {
            *error += "the file lies outside the model's folder";
            return false;
        }
        const std::vector<std::byte> bytes = read_file(path, std::min(reader.bytes_left, max_file_bytes));
        reader.bytes_left -= bytes.size();
        const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
        out->assign(first, first + bytes.size());
        return true;
    } catch (const std::exception& problem) {
        *error += problem.what();
        return false;
    }
}

// Pictures are decoded later and only if a material needs them; those in buffer views are found there again.
bool keep_image(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void* user) {
    if (image->bufferView < 0 && size > 0) {
        const auto* first = reinterpret_cast<const std::byte*>(bytes);
        static_cast<Reader*>(user)->file->external_images[index].assign(first, first + size);
    }
    return true;
}

// Of a binary file: magic, version, length; then the JSON chunk's length and type.
constexpr std::size_t glb_header = 20;

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

std::string_view json_of(std::span<const std::byte> bytes, bool binary, const std::string& shown) {
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    if (!binary) {
        return {text, bytes.size()};
    }
    if (bytes.size() < glb_header || word(bytes, 12) > bytes.size() - glb_header || word(bytes, 8) > bytes.size()) {
        fail("{}: the file is cut off", shown);
    }
    if (word(bytes, 4) != 2) {
        fail("{}: glTF version {}; only version 2 is read", shown, word(bytes, 4));
    }
    return {text + glb_header, word(bytes, 12)};
}

// The first of the parser's complaints, as one line.
std::string first_line(const std::string& complaints) {
    const std::size_t begin = complaints.find_first_not_of("\r\n ");
    const std::string line = begin == std::string::npos
                                 ? "not a valid file"
                                 : complaints.substr(begin, complaints.find('\n', begin) - begin);
    return clean_text(line.substr(0, line.find_last_not_of(" .") + 1));
}

void put_word(std::vector<std::byte>& bytes, std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(bytes.data() + at, &word, sizeof(word));
}

// The file with another JSON; what follows the JSON in a binary file stays.
std::vector<std::byte> with_json(std::span<const std::byte> bytes, bool binary, std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto text = std::as_bytes(std::span(json));
    std::vector<std::byte> whole(text.begin(), text.end());
    if (binary) {
        const std::span<const std::byte> rest = bytes.subspan(glb_header + word(bytes, 12));
        whole.insert(whole.begin(), bytes.begin(), bytes.begin() + glb_header);
        whole.insert(whole.end(), rest.begin(), rest.end());
        put_word(whole, 8, whole.size());
        put_word(whole, 12, json.size());
    }
    return whole;
}

}  // namespace

File parse_file(const std::filesystem::path& path, const Assets& assets) {
    File file;
    file.shown = clean_text(path.string());
    Reader reader{Folder(path, assets), &file};
    std::vector<std::byte> bytes = read_file(path);
    if (bytes.empty()) {
        fail("{}: the file is empty; a glTF file was expected", file.shown);
    }
    if (bytes.size() < 4) {
        fail("{}: the file is cut off", file.shown);
    }
    const bool binary = std::memcmp(bytes.data(), "glTF", 4) == 0;
    const std::string_view json = json_of(bytes, binary, file.shown);
    check_json(json, file.shown);
    if (std::optional<std::string> readable = readable_json(json)) {
        bytes = with_json(bytes, binary, std::move(*readable));
    }

    // The parser sees files only through the callbacks.
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({&file_exists, &expand_path, &read_whole_file, nullptr, &reader});
    parser.SetImageLoader(&keep_image, &reader);
    std::string errors;
    std::string warnings;
    bool good = false;
    const auto size = static_cast<unsigned>(bytes.size());
    const std::string root = reader.folder.root().string();
    try {
        good = binary ? parser.LoadBinaryFromMemory(&file.data, &errors, &warnings,
                                                    reinterpret_cast<const unsigned char*>(bytes.data()), size, root)
                      : parser.LoadASCIIFromString(&file.data, &errors, &warnings,
                                                   reinterpret_cast<const char*>(bytes.data()), size, root);
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory to read the file", file.shown);
    } catch (const std::exception& problem) {
        fail("{}: not a valid glTF file ({})", file.shown, first_line(problem.what()));
    }
    if (!good) {
        // A buffer that cannot be had says more than the parser does.
        for (const auto& [name, refusal] : file.refusals) {
            if (errors.find(name) != std::string::npos) {
                fail("{}: {}", file.shown, refusal);
            }
        }
        fail("{}: not a valid glTF file ({})", file.shown, first_line(errors));
    }
    file.notes = reader.folder.take_notes();
    note_extensions(file);
    unpack_views(file);
    return file;
}

std::optional<double> number(const tinygltf::Value& object, const std::string& key) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) {
        return std::nullopt;
    }
    return object.Get(key).GetNumberAsDouble();
}

}  // namespace gn::gltf

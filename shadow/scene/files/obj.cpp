// SPDX-License-Identifier: MIT
// Wavefront OBJ: polygons with texture coordinates, normals, groups and materials; coordinates in double precision.
#include "base/error.h"
#include "shadow/scene/files/files.h"
#include "shadow/scene/files/mtl.h"
#include "shadow/scene/files/polygon.h"
#include "shadow/scene/files/text.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <unordered_map>

namespace gn {

namespace {

constexpr std::size_t largest_file = std::size_t{1} << 30U;
// Beyond, all triangles of a material become one object.
constexpr std::size_t most_groups = 10'000;

// Indices from 0 into the file's lists; -1: not given; -2: not a valid index.
struct Corner {
    std::int64_t v = -2, vt = -1, vn = -1;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        auto h = static_cast<std::uint64_t>(c.v) * 0x9E3779B97F4A7C15U;
        h = (h ^ (h >> 29U) ^ static_cast<std::uint64_t>(c.vt)) * 0xBF58476D1CE4E5B9U;
        h = (h ^ (h >> 32U) ^ static_cast<std::uint64_t>(c.vn)) * 0x94D049BB133111EBU;
        return h ^ (h >> 31U);
    }
};

// Faces as they stand in the file; a face may name vertices that come later.
struct Face {
    std::size_t first_corner;
    std::uint32_t corners;
    std::uint32_t group;
};

struct ObjFile {
    std::vector<dvec3> positions;
    std::vector<vec3> normals;
    std::vector<vec2> uvs;
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<std::pair<std::string, std::string>> groups;  // object, material
    std::vector<std::string> libraries;
    std::size_t odd_numbers = 0, lines_and_points = 0, free_forms = 0, calls = 0, colored = 0, not_understood = 0;
    std::string first_not_understood;
};

class Parser {
  public:
    explicit Parser(ObjFile& file) : file_(file) {}

    void parse(std::string_view text) {
        Lines lines(text);
        std::string_view line;
        while (lines.next(line)) {
            parse_line(line);
        }
    }

  private:
    void parse_line(std::string_view line) {
        const std::string_view key = take_word(line);
        if (key == "v") {
            file_.positions.push_back(read3(line));
            note_color(line);
        } else if (key == "vn") {
            file_.normals.emplace_back(read3(line));
        } else if (key == "vt") {
            // Rows of pictures go down, texture coordinates of the file go up.
            const double u = read1(line);
            file_.uvs.emplace_back(u, 1.0 - read1(line));
        } else if (key == "f") {
            parse_face(line);
        } else if (key == "o" || key == "g") {
            object_ = std::string(trimmed(line));
            group_ = unknown_group;
        } else if (key == "usemtl") {
            material_ = std::string(trimmed(line));
            group_ = unknown_group;
        } else if (key == "mtllib") {
            file_.libraries.emplace_back(trimmed(line));
        } else if (key == "l" || key == "p") {
            ++file_.lines_and_points;
        } else if (is_one_of(key, free_forms)) {
            ++file_.free_forms;
        } else if (key == "call" || key == "csh") {
            ++file_.calls;
        } else if (!key.empty() && key.front() != '#' && !is_one_of(key, without_triangles)) {
            file_.first_not_understood = file_.not_understood++ == 0 ? clean_text(key) : file_.first_not_understood;
        }
    }

    // Curves and surfaces; what describes, joins and shows them, and what only concerns other programs.
    static constexpr std::array<std::string_view, 7> free_forms{"curv", "curv2", "surf", "bzp", "bsp", "cdc", "res"};
    static constexpr std::array<std::string_view, 25> without_triangles{
        "vp",     "cstype",     "deg",       "bmat",     "step",  "parm",     "trim", "hole", "scrv",
        "sp",     "end",        "con",       "s",        "mg",    "bevel",    "cdp",  "lod",  "usemap",
        "maplib", "shadow_obj", "trace_obj", "c_interp", "ctech", "d_interp", "stech"};
    template <std::size_t Count>
    static bool is_one_of(std::string_view key, const std::array<std::string_view, Count>& keys) {
        return std::find(keys.begin(), keys.end(), key) != keys.end();
    }

    // A fourth number is a weight; three more than the point are a colour.
    void note_color(std::string_view line) {
        int numbers = 0;
        for (std::string_view word = take_word(line); !word.empty() && leading_number(word); word = take_word(line)) {
            ++numbers;
        }
        file_.colored += numbers >= 6 ? 1U : 0U;
    }

    double read1(std::string_view& line) {
        const std::string_view word = take_word(line);
        const std::optional<double> value = leading_number(word);
        file_.odd_numbers += value ? 0U : 1U;
        return value.value_or(0.0);
    }

    dvec3 read3(std::string_view line) {
        const double x = read1(line);
        const double y = read1(line);
        return {x, y, read1(line)};
    }

    void parse_face(std::string_view line) {
        const Face face{file_.corners.size(), 0, current_group()};
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            file_.corners.push_back(parse_corner(word));
        }
        file_.faces.push_back(face);
        file_.faces.back().corners = static_cast<std::uint32_t>(file_.corners.size() - face.first_corner);
    }

    Corner parse_corner(std::string_view word) {
        const auto part = [&] {
            const std::size_t slash = std::min(word.find('/'), word.size());
            const std::string_view piece = word.substr(0, slash);
            word.remove_prefix(std::min(slash + 1, word.size()));
            return piece;
        };
        Corner corner;
        corner.v = parse_index(part(), file_.positions.size(), -2);
        corner.vt = parse_optional(part(), file_.uvs.size());
        corner.vn = parse_optional(part(), file_.normals.size());
        return corner;
    }

    static std::int64_t parse_optional(std::string_view text, std::size_t so_far) {
        return text.empty() ? -1 : parse_index(text, so_far, -2);
    }

    // From 1; negative ones count back from the last element so far.
    static std::int64_t parse_index(std::string_view text, std::size_t so_far, std::int64_t otherwise) {
        std::int64_t index = 0;
        text.remove_prefix(!text.empty() && text.front() == '+' ? 1 : 0);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
        if (error != std::errc() || index == 0) {
            return otherwise;
        }
        const std::int64_t resolved = index > 0 ? index - 1 : static_cast<std::int64_t>(so_far) + index;
        return resolved >= 0 ? resolved : otherwise;
    }

    std::uint32_t current_group() {
        if (group_ == unknown_group) {
            const bool crowded = file_.groups.size() >= most_groups;
            const std::pair key(crowded ? std::string() : object_, material_);
            const auto [found, added] = groups_.emplace(key, static_cast<std::uint32_t>(file_.groups.size()));
            if (added) {
                file_.groups.push_back(key);
            }
            group_ = found->second;
        }
        return group_;
    }

    static constexpr std::uint32_t unknown_group = 0xFFFFFFFFU;
    ObjFile& file_;
    std::string object_, material_;
    std::uint32_t group_ = unknown_group;
    std::map<std::pair<std::string, std::string>, std::uint32_t> groups_;
};

// Turns faces into one indexed mesh per group.
class MeshMaker {
  public:
    MeshMaker(const ObjFile& file, Model& model) : file_(file), model_(model) {
        by_group_.resize(file.groups.size());
        model.meshes.resize(file.groups.size());
        placed_.resize(file.groups.size());
    }

    void add(const Face& face) {
        // A face with an impossible corner is no face.
        std::vector<dvec3> outline;
        for (std::uint32_t i = 0; i < face.corners; ++i) {
            const Corner& corner = file_.corners[face.first_corner + i];
            if (corner.v < 0 || corner.v >= static_cast<std::int64_t>(file_.positions.size())) {
                ++dropped_;
                return;
            }
            outline.push_back(file_.positions[static_cast<std::size_t>(corner.v)]);
        }
        dropped_ += outline.size() < 3 ? 1U : 0U;

        Mesh& mesh = model_.meshes[face.group];
        for (const uvec3 t : triangulate(outline)) {
            uvec3 indices;
            for (int corner = 0; corner < 3; ++corner) {
                indices[corner] = vertex(face.group, mesh, file_.corners[face.first_corner + t[corner]]);
            }
            mesh.triangles.push_back(indices);
            ++triangles_;
        }
        if (triangles_ > max_triangles) {
            fail("the file has more than {} triangles", max_triangles);
        }
    }

    [[nodiscard]] std::size_t dropped() const { return dropped_; }
    [[nodiscard]] std::size_t missing_uvs() const { return missing_uvs_; }
    [[nodiscard]] std::size_t missing_normals() const { return missing_normals_; }

    /// The maps of a group's material lie on its coordinates like this.
    void place_maps(std::size_t group, const MapPlacement& placed) { placed_.at(group) = placed; }

  private:
    // Coordinates of the file go up, ours go down: v = 1 - (scale (1 - v) + offset).
    [[nodiscard]] vec2 place(std::uint32_t group, vec2 uv) const {
        const MapPlacement& placed = placed_[group];
        return placed.scale == vec2(1.0F) && placed.offset == vec2(0.0F)
                   ? uv
                   : vec2(placed.scale.x * uv.x + placed.offset.x,
                          1.0F - placed.scale.y * (1.0F - uv.y) - placed.offset.y);
    }

    std::uint32_t vertex(std::uint32_t group, Mesh& mesh, Corner corner) {
        const auto exists = [](std::int64_t index, std::size_t count) {
            return index >= 0 && index < static_cast<std::int64_t>(count);
        };
        if (corner.vt != -1 && !exists(corner.vt, file_.uvs.size())) {
            corner.vt = -1;
            ++missing_uvs_;
        }
        if (corner.vn != -1 && !exists(corner.vn, file_.normals.size())) {
            corner.vn = -1;
            ++missing_normals_;
        }
        const auto next = static_cast<std::uint32_t>(mesh.positions_os.size());
        const auto [found, added] = by_group_[group].emplace(corner, next);
        if (added) {
            mesh.positions_os.push_back(file_.positions[static_cast<std::size_t>(corner.v)]);
            mesh.normals_os.push_back(corner.vn >= 0 ? file_.normals[static_cast<std::size_t>(corner.vn)] : vec3(0.0F));
            mesh.uvs.push_back(corner.vt >= 0 ? place(group, file_.uvs[static_cast<std::size_t>(corner.vt)])
                                              : vec2(0.0F));
        }
        return found->second;
    }

    const ObjFile& file_;
    Model& model_;
    std::vector<std::unordered_map<Corner, std::uint32_t, CornerHash>> by_group_;
    std::vector<MapPlacement> placed_;
    std::size_t dropped_ = 0, triangles_ = 0, missing_uvs_ = 0, missing_normals_ = 0;
};

void note_oddities(const ObjFile& file, const MeshMaker& maker, std::vector<std::string>& notes) {
    note_count(notes, maker.dropped(), "Dropped 1 face with vertices that are not there or fewer than 3 corners.",
               "Dropped {} faces with vertices that are not there or fewer than 3 corners.");
    note_count(notes, file.odd_numbers, "Read 1 coordinate that is no number as 0.",
               "Read {} coordinates that are no numbers as 0.");
    note_count(notes, maker.missing_uvs(), "Read 1 texture coordinate that is not there as (0, 0).",
               "Read {} texture coordinates that are not there as (0, 0).");
    note_count(notes, maker.missing_normals(), "Made 1 normal that is not there from its faces.",
               "Made {} normals that are not there from their faces.");
    note_count(notes, file.lines_and_points, "Skipped 1 line or point: only faces cast shadows.",
               "Skipped {} lines and points: only faces cast shadows.");
    note_count(notes, file.free_forms, "Skipped 1 free-form curve or surface: only polygons are read.",
               "Skipped {} free-form curves and surfaces: only polygons are read.");
    note_count(notes, file.calls, "Did not read 1 other file that it calls.",
               "Did not read {} other files that it calls.");
    note_count(notes, file.colored, "1 vertex has a colour, which is not read.",
               "{} vertices have colours, which are not read.");
    if (file.not_understood > 0) {
        add_note(notes, fmt::format("Did not understand {} line{}, the first of them '{}'.", file.not_understood,
                                    file.not_understood == 1 ? "" : "s", file.first_not_understood));
    }
}

}  // namespace

Model load_obj(const std::filesystem::path& path, const Assets& assets) {
    const Folder folder(path, assets);
    ObjFile file;
    {
        const std::string text = decode_text(read_file(path, largest_file));
        Parser(file).parse(text);
    }
    if (file.positions.empty() && file.faces.empty()) {
        fail("{}: no vertices and no faces; is this an OBJ file?", clean_text(path.string()));
    }

    // Materials first: meshes refer to them.
    Model model;
    MaterialLibrary library(folder, model);
    for (const std::string& names : file.libraries) {
        library.read(names);
    }
    MeshMaker maker(file, model);
    for (std::size_t g = 0; g < file.groups.size(); ++g) {
        model.meshes[g].name = clean_text(file.groups[g].first);
        model.meshes[g].material = library.find(file.groups[g].second);
        maker.place_maps(g, library.placement(model.meshes[g].material));
    }
    for (const Face& face : file.faces) {
        maker.add(face);
    }
    note_oddities(file, maker, model.notes);
    for (std::string& note : folder.take_notes()) {
        add_note(model.notes, std::move(note));
    }
    for (std::size_t g = 0; g < model.meshes.size(); ++g) {
        if (!model.meshes[g].triangles.empty()) {
            model.instances.push_back({g, dmat4(1.0), model.meshes[g].name});
        }
    }
    return model;
}

}  // namespace gn

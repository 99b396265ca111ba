// SPDX-License-Identifier: MIT
// The one list of glTF extensions: what is understood, what only changes how surfaces look, what may be missed unseen.
#include "shadow/scene/files/gltf_data.h"

#include <algorithm>
#include <array>
#include <set>

namespace gn::gltf {

namespace {

using Names = std::span<const std::string_view>;

// Read, and acted upon.
constexpr auto understood = std::to_array<std::string_view>(
    {"KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization", "EXT_meshopt_compression",
     "KHR_meshopt_compression", "KHR_materials_emissive_strength", "KHR_materials_pbrSpecularGlossiness",
     "KHR_materials_transmission", "KHR_node_visibility", "EXT_mesh_gpu_instancing", "EXT_texture_webp",
     "KHR_draco_mesh_compression"});

// Nothing of it could be seen: data about data, sound, behaviour.
constexpr auto unseen = std::to_array<std::string_view>({"KHR_xmp",
                                                         "KHR_xmp_json_ld",
                                                         "KHR_audio_emitter",
                                                         "KHR_interactivity",
                                                         "KHR_node_selectability",
                                                         "KHR_node_hoverability",
                                                         "KHR_physics_rigid_bodies",
                                                         "KHR_implicit_shapes",
                                                         "KHR_animation_pointer",
                                                         "EXT_mesh_features",
                                                         "EXT_instance_features",
                                                         "EXT_structural_metadata",
                                                         "EXT_mesh_manifold",
                                                         "MSFT_packing_normalRoughnessMetallic",
                                                         "MSFT_packing_occlusionRoughnessMetallic",
                                                         "MSFT_lod",
                                                         "FB_geometry_metadata",
                                                         "GODOT_single_root",
                                                         "OMI_physics_body",
                                                         "OMI_physics_shape"});

// The surface is where it is without it, only shaded otherwise.
constexpr auto looks = std::to_array<std::string_view>(
    {"KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_dispersion", "KHR_materials_ior",
     "KHR_materials_iridescence", "KHR_materials_sheen", "KHR_materials_specular", "KHR_materials_subsurface",
     "KHR_materials_unlit", "KHR_materials_variants", "KHR_materials_volume", "AGI_articulations",
     "CESIUM_primitive_outline", "EXT_lights_image_based", "EXT_lights_ies", "EXT_texture_video", "NV_materials_mdl",
     "VRMC_materials_mtoon"});

// The surface lets light through, in ways that are not read.
constexpr auto translucent =
    std::to_array<std::string_view>({"KHR_materials_diffuse_transmission", "ADOBE_materials_thin_transparency"});

// Pictures in formats that are not read; a mask among them is lost, which the material says.
constexpr auto unread_pictures =
    std::to_array<std::string_view>({"KHR_texture_basisu", "EXT_texture_avif", "EXT_texture_astc", "MSFT_texture_dds"});

bool among(Names names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

void note_group(File& file, const std::set<std::string>& names, const char* sentence) {
    if (!names.empty()) {
        add_note(file.notes, fmt::format("{}: {}.", sentence, fmt::join(names, ", ")));
    }
}

}  // namespace

void note_extensions(File& file) {
    std::set<std::string> of_looks;
    std::set<std::string> of_light;
    std::set<std::string> of_pictures;
    std::set<std::string> unknown;
    std::set<std::string> needed;
    const auto sort_in = [&](const std::string& name, bool required) {
        if (among(understood, name) || among(unseen, name)) {
            return;
        }
        if (among(looks, name)) {
            of_looks.insert(name);
        } else if (among(translucent, name)) {
            of_light.insert(name);
        } else if (among(unread_pictures, name)) {
            of_pictures.insert(name);
        } else {
            (required ? needed : unknown).insert(clean_text(name));
        }
    };
    for (const std::string& name : file.data.extensionsUsed) {
        sort_in(name, false);
    }
    for (const std::string& name : file.data.extensionsRequired) {
        sort_in(name, true);
    }
    for (const std::string& name : needed) {
        unknown.erase(name);
    }
    note_group(file, of_looks, "Left out, as it only changes how surfaces look");
    note_group(file, of_light,
               "Lets light through in a way that is not read, so that what wears it casts as if it were solid");
    note_group(file, of_pictures,
               "Pictures in formats that are not read; another picture or a plain colour stands for them");
    note_group(file, unknown, "Not understood, so that shapes or holes may be missing");
    note_group(file, needed,
               "Required by the file and not understood, so that shapes or holes may be missing or wrong");
}

}  // namespace gn::gltf

// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression: the triangles and attributes of a primitive as one stream of the Draco codec.
//
// The codec checks what it reads but allocates what a stream promises. So its decoders are derived from: both asks, for the
// triangles and for the attributes, are held to a budget before they are granted.
#include "shadow/scene/files/gltf_packed.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>

namespace gn::gltf {

namespace {

// Real meshes spend some bytes on a vertex that unpacks to a hundred; a flat grid may spend a hundredth of that. What
// unpacks to more than 4096 times its size is no mesh. The rest is for small streams.
constexpr std::uint64_t most_bytes_per_byte = 4096;
constexpr std::uint64_t bytes_for_any = 1 << 20;
// Half edges, vertices, maps from corners to points and the faces themselves: bytes a triangle, and more for each set of
// attributes that has seams of its own.
constexpr std::uint64_t bytes_per_face = 96;
constexpr std::uint64_t bytes_per_seam = 24;

struct Budget {
    std::uint64_t bytes = 0;
    bool exceeded = false;
    bool grants(std::uint64_t asked) {
        exceeded = exceeded || asked > bytes;
        return !exceeded;
    }
};

template <class Decoder, bool has_seams>
class Bounded : public Decoder {
  public:
    explicit Bounded(Budget& budget) : budget_(budget) {}

  protected:
    bool DecodeConnectivity() override {
        // Read ahead: vertices, faces and sets with seams, or faces and points.
        draco::DecoderBuffer ahead = *this->buffer();
        std::uint32_t first = 0;
        std::uint32_t second = 0;
        std::uint8_t seams = 0;
        if (this->bitstream_version() < DRACO_BITSTREAM_VERSION(2, 2) || !draco::DecodeVarint(&first, &ahead) ||
            !draco::DecodeVarint(&second, &ahead) || (has_seams && !ahead.Decode(&seams))) {
            return false;
        }
        const std::uint64_t faces = has_seams ? second : first;
        const std::uint64_t points = has_seams ? first : second;
        return faces <= max_triangles &&
               budget_.grants(faces * (bytes_per_face + bytes_per_seam * seams) + points * bytes_per_face) &&
               Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        // Every value stands twice for a while: as an integer of four bytes, and as itself.
        std::uint64_t bytes_per_point = 0;
        for (int i = 0; i < this->point_cloud()->num_attributes(); ++i) {
            const draco::PointAttribute& a = *this->point_cloud()->attribute(i);
            const auto size = static_cast<std::uint64_t>(std::max(draco::DataTypeLength(a.data_type()), 1));
            bytes_per_point += 8 + a.num_components() * (4 + size);
        }
        return budget_.grants(bytes_per_point * this->point_cloud()->num_points()) && Decoder::DecodeAllAttributes();
    }

  private:
    Budget& budget_;
};

template <class Decoder>
draco::Status decode(draco::DecoderBuffer& stream, Budget& budget, draco::Mesh& mesh) {
    Decoder decoder(budget);
    return decoder.Decode(draco::DecoderOptions(), &stream, &mesh);
}

std::unique_ptr<draco::Mesh> decode_mesh(std::span<const unsigned char> bytes, const std::string& name) {
    draco::DecoderBuffer stream;
    stream.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer ahead = stream;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH) {
        fail("{} is not a mesh in Draco's format", name);
    }
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        fail("{} carries metadata, which is not read; save the file without it", name);
    }

    Budget budget{std::min<std::uint64_t>(max_unpacked_bytes, bytes_for_any + most_bytes_per_byte * bytes.size())};
    auto mesh = std::make_unique<draco::Mesh>();
    draco::Status status;
    try {
        using Edgebreaker = Bounded<draco::MeshEdgebreakerDecoder, true>;
        using Sequential = Bounded<draco::MeshSequentialDecoder, false>;
        status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING ? decode<Edgebreaker>(stream, budget, *mesh)
                                                                           : decode<Sequential>(stream, budget, *mesh);
    } catch (const std::exception&) {
        fail("{} is damaged", name);
    }
    if (budget.exceeded) {
        fail("{} promises more than {} bytes from {}", name, budget.bytes, bytes.size());
    }
    if (!status.ok()) {
        fail("{} is damaged ({})", name, clean_text(status.error_msg_string()));
    }
    return mesh;
}

template <class T>
void write_values(const draco::PointAttribute& from, const draco::Mesh& mesh, int components, const std::string& name,
                  std::vector<unsigned char>& out) {
    const auto each = static_cast<std::size_t>(components);
    std::vector<T> values(mesh.num_points() * each);
    for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
        if (!from.ConvertValue<T>(from.mapped_index(draco::PointIndex(p)), static_cast<std::int8_t>(components),
                                  values.data() + p * each)) {
            fail("{} has values that its accessor cannot hold", name);
        }
    }
    out.resize(values.size() * sizeof(T));
    std::memcpy(out.data(), values.data(), out.size());
}

// An attribute as its accessor declares it, without gaps.
std::vector<unsigned char> as_declared(const draco::PointAttribute& from, const draco::Mesh& mesh,
                                       const tinygltf::Accessor& accessor, const std::string& name) {
    const int components = count_components(accessor.type);
    if (components < 1 || components > 4) {
        fail("{} has an accessor of a type that is not supported ({})", name, accessor.type);
    }
    std::vector<unsigned char> out;
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: write_values<std::int8_t>(from, mesh, components, name, out); break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            write_values<std::uint8_t>(from, mesh, components, name, out);
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT: write_values<std::int16_t>(from, mesh, components, name, out); break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            write_values<std::uint16_t>(from, mesh, components, name, out);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            write_values<std::uint32_t>(from, mesh, components, name, out);
            break;
        default: write_values<float>(from, mesh, components, name, out);
    }
    return out;
}

}  // namespace

std::optional<UnpackedPrimitive> unpack_primitive(const File& file, const tinygltf::Primitive& primitive) {
    const auto found = primitive.extensions.find(draco_name);
    const auto position = primitive.attributes.find("POSITION");
    if (found == primitive.extensions.end() || position == primitive.attributes.end() ||
        at(file.data.accessors, position->second, file, "accessor").bufferView >= 0) {
        return std::nullopt;
    }
    const auto view = whole(found->second, "bufferView");
    const bool known = view && *view < file.data.bufferViews.size();
    const std::string name = fmt::format("{}: {} of buffer view {}", file.shown, draco_name, known ? *view : 0);
    if (!known || !found->second.Has("attributes") || !found->second.Get("attributes").IsObject()) {
        fail("{}: {} needs a bufferView that exists, and attributes", file.shown, draco_name);
    }

    const std::unique_ptr<draco::Mesh> decoded = decode_mesh(view_bytes(file, static_cast<int>(*view)), name);
    const draco::Mesh& mesh = *decoded;
    UnpackedPrimitive unpacked;
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
            unpacked.indices.push_back(point.value());
        }
    }
    const tinygltf::Value& attributes = found->second.Get("attributes");
    for (const auto& [attribute, accessor] : primitive.attributes) {
        if (!attributes.Has(attribute)) {
            continue;
        }
        const auto id = whole(attributes, attribute);
        const draco::PointAttribute* from =
            id && *id < 0x1p32 ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(*id)) : nullptr;
        if (from == nullptr) {
            fail("{} has no attribute for {}", name, clean_text(attribute));
        }
        unpacked.attributes[attribute] =
            as_declared(*from, mesh, at(file.data.accessors, accessor, file, "accessor"), name);
    }
    return unpacked;
}

}  // namespace gn::gltf

// SPDX-License-Identifier: MIT
// Accessors: every offset, stride and sparse index is checked once, then elements are read without further ado.
#include "shadow/scene/files/gltf_packed.h"

#include <algorithm>
#include <cstring>

namespace gn::gltf {

namespace {

int size_of_component(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

template <class T>
double read_as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
}

double read_component(const unsigned char* bytes, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return read_as<std::int8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read_as<std::uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return read_as<std::int16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read_as<std::uint16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read_as<std::uint32_t>(bytes);
        default: return read_as<float>(bytes);
    }
}

// Integers that stand for [0,1] or [-1,1], by the equations of the glTF specification, section 3.6.2.
double normalize_integer(double value, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return std::max(value / 127.0, -1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return value / 255.0;
        case TINYGLTF_COMPONENT_TYPE_SHORT: return std::max(value / 32767.0, -1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return value / 65535.0;
        default: return value;
    }
}

}  // namespace

int count_components(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR: return 1;
        case TINYGLTF_TYPE_VEC2: return 2;
        case TINYGLTF_TYPE_VEC3: return 3;
        case TINYGLTF_TYPE_VEC4: return 4;
        case TINYGLTF_TYPE_MAT4: return 16;
        default: return 0;
    }
}

void Elements::take_form(const File& file, int accessor_index) {
    const tinygltf::Accessor& accessor = at(file.data.accessors, accessor_index, file, "accessor");
    name_ = fmt::format("{}: accessor {}", file.shown, accessor_index);
    component_type_ = accessor.componentType;
    component_size_ = size_of_component(component_type_);
    components_ = count_components(accessor.type);
    normalized_ = accessor.normalized;
    count_ = accessor.count;
    if (component_size_ == 0 || components_ == 0) {
        fail("{} has a type that is not supported (component {}, type {})", name_, component_type_, accessor.type);
    }
    if (count_ > std::numeric_limits<std::uint32_t>::max()) {
        fail("{} has {} elements; at most 4294967295 can be addressed", name_, count_);
    }
}

Elements::Elements(const File& file, int accessor_index, std::span<const unsigned char> bytes) {
    take_form(file, accessor_index);
    base_ = {bytes.data(), static_cast<std::size_t>(component_size_ * components_)};
    count_ = bytes.size() / base_.stride;
}

Elements::Elements(const File& file, int accessor_index) {
    take_form(file, accessor_index);
    const tinygltf::Accessor& accessor = at(file.data.accessors, accessor_index, file, "accessor");

    // Without a buffer view the elements are zeros, which cost no memory here.
    if (accessor.bufferView >= 0) {
        const auto element_size = static_cast<std::size_t>(component_size_ * components_);
        base_ = locate(file, accessor.bufferView, accessor.byteOffset, count_, element_size, false);
    }
    if (accessor.sparse.isSparse) {
        read_sparse(file, accessor);
    }
}

Elements::Run Elements::locate(const File& file, int view_index, std::size_t offset, std::size_t count,
                               std::size_t element_size, bool packed) const {
    const tinygltf::BufferView& view = at(file.data.bufferViews, view_index, file, "buffer view");
    const std::span<const unsigned char> bytes = view_bytes(file, view_index);

    // The last element need not fill its stride.
    const std::size_t stride = packed || view.byteStride == 0 ? element_size : view.byteStride;
    if (stride < element_size) {
        fail("{}: buffer view {} has a stride of {} bytes for elements of {}", file.shown, view_index, stride,
             element_size);
    }
    const bool inside = count == 0 || (offset <= bytes.size() && element_size <= bytes.size() - offset &&
                                       (count - 1) <= (bytes.size() - offset - element_size) / stride);
    if (!inside) {
        fail("{} does not fit into its buffer view of {} bytes", name_, bytes.size());
    }
    return {count == 0 ? nullptr : bytes.data() + offset, stride};
}

void Elements::read_sparse(const File& file, const tinygltf::Accessor& accessor) {
    const auto& sparse = accessor.sparse;
    const int index_type = sparse.indices.componentType;
    const auto index_size = static_cast<std::size_t>(size_of_component(index_type));
    const bool unsigned_type = index_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                               index_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                               index_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!unsigned_type || sparse.count < 0 || static_cast<std::size_t>(sparse.count) > count_ ||
        sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
        fail("{} overrides {} of its {} elements in an invalid way", name_, sparse.count, count_);
    }

    const auto count = static_cast<std::size_t>(sparse.count);
    const auto element_size = static_cast<std::size_t>(component_size_ * components_);
    const Run indices = locate(file, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                               count, index_size, true);
    const Run values = locate(file, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                              element_size, true);
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(read_component(indices.bytes + i * index_size, index_type));
        if (index >= count_) {
            fail("{} overrides element {} of {}", name_, index, count_);
        }
        sparse_[index] = values.bytes + i * element_size;
    }
}

const unsigned char* Elements::element(std::size_t index) const {
    if (!sparse_.empty()) {
        const auto found = sparse_.find(static_cast<std::uint32_t>(index));
        if (found != sparse_.end()) {
            return found->second;
        }
    }
    return base_.bytes == nullptr ? nullptr : base_.bytes + index * base_.stride;
}

double Elements::component(const unsigned char* bytes, int component) const {
    const double value = read_component(bytes + component * component_size_, component_type_);
    return normalized_ ? normalize_integer(value, component_type_) : value;
}

dvec4 Elements::vector(std::size_t index) const {
    dvec4 v(0.0);
    const unsigned char* bytes = element(index);
    for (int i = 0; bytes != nullptr && i < std::min(components_, 4); ++i) {
        v[i] = component(bytes, i);
    }
    return v;
}

dmat4 Elements::matrix(std::size_t index) const {
    dmat4 m(0.0);
    const unsigned char* bytes = element(index);
    for (int i = 0; bytes != nullptr && i < std::min(components_, 16); ++i) {
        m[i / 4][i % 4] = component(bytes, i);
    }
    return m;
}

std::uint32_t Elements::integer(std::size_t index) const {
    const unsigned char* bytes = element(index);
    const double value = bytes == nullptr ? 0.0 : read_component(bytes, component_type_);
    return value >= 0.0 && value < 4294967295.0 ? static_cast<std::uint32_t>(value)
                                                : std::numeric_limits<std::uint32_t>::max();
}

}  // namespace gn::gltf

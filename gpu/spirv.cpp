// SPDX-License-Identifier: MIT
#include "gpu/spirv.h"

#include <vulkan/vulkan.h>

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>

namespace gn {
namespace {

// The part of the SPIR-V 1.6 vocabulary that describes interfaces.
enum Op : std::uint32_t {
    op_name = 5,
    op_type_int = 21,
    op_type_float = 22,
    op_type_vector = 23,
    op_type_matrix = 24,
    op_type_image = 25,
    op_type_sampler = 26,
    op_type_sampled_image = 27,
    op_type_array = 28,
    op_type_runtime_array = 29,
    op_type_struct = 30,
    op_type_pointer = 32,
    op_constant = 43,
    op_spec_constant = 50,
    op_function_call = 57,
    op_variable = 59,
    op_image_texel_pointer = 60,
    op_load = 61,
    op_store = 62,
    op_copy_memory = 63,
    op_access_chain = 65,
    op_in_bounds_access_chain = 66,
    op_array_length = 68,
    op_decorate = 71,
    op_member_decorate = 72,
    op_copy_object = 83,
};
enum Decoration : std::uint32_t {
    array_stride = 6,
    matrix_stride = 7,
    buffer_block = 3,
    binding_number = 33,
    descriptor_set = 34,
    byte_offset = 35
};
enum StorageClass : std::uint32_t { uniform_constant = 0, uniform = 2, push_constant = 9, storage_buffer = 12 };

using Words = std::span<const std::uint32_t>;

struct Type {
    std::uint32_t op = 0;
    std::vector<std::uint32_t> operands;  ///< after the result id
};

struct Variable {
    std::uint32_t id, type, storage;
};

struct Module {
    std::unordered_map<std::uint32_t, std::string> names;
    std::unordered_map<std::uint32_t, Type> types;
    std::unordered_map<std::uint32_t, std::uint32_t> constants;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> decorations;  ///< (id, decoration) -> operand
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> member_decorations;
    std::vector<Variable> variables;
    std::set<std::uint32_t> touched;

    [[nodiscard]] const Type& type(std::uint32_t id) const {
        static const Type none;
        const auto found = types.find(id);
        return found != types.end() ? found->second : none;
    }
    [[nodiscard]] std::optional<std::uint32_t> decoration(std::uint32_t id, std::uint32_t which) const {
        const auto found = decorations.find({id, which});
        return found != decorations.end() ? std::optional(found->second) : std::nullopt;
    }
};

std::string text_of(Words words) {
    std::string text;
    for (const std::uint32_t word : words) {
        for (unsigned byte = 0; byte < 4; ++byte) {
            const char c = static_cast<char>((word >> (8U * byte)) & 0xFFU);
            if (c == '\0') {
                return text;
            }
            text += c;
        }
    }
    return text;
}

/// Notes which ids an instruction inside a function reads or writes through.
void note_touched(Module& module, std::uint32_t op, Words w) {
    switch (op) {
        case op_load:
        case op_image_texel_pointer:
        case op_access_chain:
        case op_in_bounds_access_chain:
        case op_array_length:
        case op_copy_object:
            if (w.size() > 3) {
                module.touched.insert(w[3]);
            }
            break;
        case op_store: module.touched.insert(w[1]); break;
        case op_copy_memory: module.touched.insert(w.begin() + 1, w.end()); break;
        case op_function_call:
            if (w.size() > 4) {
                module.touched.insert(w.begin() + 4, w.end());
            }
            break;
        default: break;
    }
}

void note_declaration(Module& module, std::uint32_t op, Words w) {
    switch (op) {
        case op_name: module.names[w[1]] = text_of(w.subspan(2)); break;
        case op_decorate: module.decorations[{w[1], w[2]}] = w.size() > 3 ? w[3] : 0; break;
        case op_member_decorate: module.member_decorations[{w[1], w[2], w[3]}] = w.size() > 4 ? w[4] : 0; break;
        case op_type_int:
        case op_type_float:
        case op_type_vector:
        case op_type_matrix:
        case op_type_image:
        case op_type_sampler:
        case op_type_sampled_image:
        case op_type_array:
        case op_type_runtime_array:
        case op_type_struct:
        case op_type_pointer: module.types[w[1]] = {op, {w.begin() + 2, w.end()}}; break;
        case op_constant:
        case op_spec_constant: module.constants[w[2]] = w.size() > 3 ? w[3] : 0; break;
        case op_variable: module.variables.push_back({w[2], w[1], w[3]}); break;
        default: break;
    }
}

Module read_module(Words spirv, const std::string& what) {
    // The shortest form of each instruction read here; a shorter one is damage.
    static const std::map<std::uint32_t, std::size_t> shortest{
        {op_name, 3},
        {op_decorate, 3},
        {op_member_decorate, 4},
        {op_type_int, 4},
        {op_type_float, 3},
        {op_type_vector, 4},
        {op_type_matrix, 4},
        {op_type_image, 9},
        {op_type_sampler, 2},
        {op_type_sampled_image, 3},
        {op_type_array, 4},
        {op_type_runtime_array, 3},
        {op_type_struct, 2},
        {op_type_pointer, 4},
        {op_constant, 4},
        {op_spec_constant, 4},
        {op_variable, 4},
        {op_store, 3},
        {op_copy_memory, 3},
        {op_function_call, 4},
    };
    Module module;
    if (spirv.size() < 5 || spirv[0] != 0x07230203U) {
        fail("shader '{}' is not a SPIR-V module", what);
    }
    for (std::size_t at = 5; at < spirv.size();) {
        const std::uint32_t op = spirv[at] & 0xFFFFU;
        const std::size_t count = spirv[at] >> 16U;
        const auto least = shortest.find(op);
        if (count == 0 || at + count > spirv.size() || (least != shortest.end() && count < least->second)) {
            fail("shader '{}' is a damaged SPIR-V module at word {}", what, at);
        }
        note_declaration(module, op, spirv.subspan(at, count));
        note_touched(module, op, spirv.subspan(at, count));
        at += count;
    }
    return module;
}

/// Bytes of a type under explicit layout, from its own strides and offsets.
std::uint32_t bytes_of(const Module& module, std::uint32_t id, std::uint32_t stride_of_matrix = 0) {
    const Type& type = module.type(id);
    switch (type.op) {
        case op_type_int:
        case op_type_float: return type.operands[0] / 8;
        case op_type_vector: return type.operands[1] * bytes_of(module, type.operands[0]);
        case op_type_matrix: {
            const std::uint32_t column = bytes_of(module, type.operands[0]);
            return (type.operands[1] - 1) * std::max(stride_of_matrix, column) + column;
        }
        case op_type_array: {
            const auto count = module.constants.find(type.operands[1]);
            const std::uint32_t stride = module.decoration(id, array_stride).value_or(0);
            return count != module.constants.end() ? count->second * stride : 0;
        }
        case op_type_struct: {
            std::uint32_t bytes = 0;
            for (std::uint32_t member = 0; member < type.operands.size(); ++member) {
                const auto at = module.member_decorations.find({id, member, byte_offset});
                const auto stride = module.member_decorations.find({id, member, matrix_stride});
                bytes = std::max(bytes, (at != module.member_decorations.end() ? at->second : 0) +
                                            bytes_of(module, type.operands[member],
                                                     stride != module.member_decorations.end() ? stride->second : 0));
            }
            return bytes;
        }
        default: return 0;
    }
}

void describe_image(const Module& module, const Type& image, ShaderBinding& binding) {
    binding.image_dim = image.operands[1];
    binding.arrayed = image.operands[3] != 0;
    binding.multisampled = image.operands[4] != 0;
    const Type& sampled = module.type(image.operands[0]);
    binding.integer = sampled.op == op_type_int;
}

ShaderBinding describe(const Module& module, const Variable& variable, std::uint32_t pointee,
                       const std::string& where) {
    ShaderBinding binding;
    const Type& type = module.type(pointee);
    switch (type.op) {
        case op_type_sampled_image:
            binding.vk_descriptor_type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            describe_image(module, module.type(type.operands[0]), binding);
            break;
        case op_type_image:
            binding.vk_descriptor_type =
                type.operands[5] == 2 ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
            describe_image(module, type, binding);
            break;
        case op_type_sampler: binding.vk_descriptor_type = VK_DESCRIPTOR_TYPE_SAMPLER; break;
        case op_type_struct: {
            const bool storage =
                variable.storage == storage_buffer || module.decoration(pointee, buffer_block).has_value();
            binding.vk_descriptor_type =
                storage ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
            binding.block_bytes = bytes_of(module, pointee);
            break;
        }
        default: fail("{} is an array of resources; use a texture array or a buffer instead", where);
    }
    return binding;
}

}  // namespace

Reflection reflect(Words spirv, const std::string& what) {
    const Module module = read_module(spirv, what);
    Reflection reflection;
    for (const Variable& variable : module.variables) {
        const Type& pointer = module.type(variable.type);
        if (pointer.op != op_type_pointer) {
            continue;
        }
        const std::uint32_t pointee = pointer.operands[1];

        // Push constants only have a size.
        if (variable.storage == push_constant) {
            reflection.push_constant_bytes = std::max(reflection.push_constant_bytes, bytes_of(module, pointee));
            continue;
        }

        // Keep what the code touches among the resources.
        if (variable.storage != uniform_constant && variable.storage != uniform && variable.storage != storage_buffer) {
            continue;
        }
        if (!module.touched.contains(variable.id)) {
            continue;
        }

        // Name it as authors do: the instance, else the block.
        auto name = module.names.find(variable.id);
        if (name == module.names.end() || name->second.empty()) {
            name = module.names.find(pointee);
        }
        const std::string label = name != module.names.end() ? name->second : "";
        const std::string where = fmt::format("shader '{}': '{}'", what, label);
        if (module.decoration(variable.id, descriptor_set).value_or(0) != 0) {
            fail("{} is in descriptor set {}; only set 0 is used", where,
                 *module.decoration(variable.id, descriptor_set));
        }
        ShaderBinding binding = describe(module, variable, pointee, where);
        binding.binding = module.decoration(variable.id, binding_number).value_or(0);
        reflection.bindings[label] = binding;
    }
    return reflection;
}

}  // namespace gn

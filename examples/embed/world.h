// SPDX-License-Identifier: MIT
// What the host shows: a clearing with a tall box and a lamp, around it a spiral of columns and balls that move.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

struct Vertex {
    glm::vec3 position_os, normal_os;
};

/// A range of the vertex and the index buffer; indices count from first_vertex.
struct Mesh {
    std::uint32_t first_vertex = 0, vertex_count = 0, first_index = 0, index_count = 0;
};

/// Objects of one mesh lie behind each other, so that one instanced draw shows them.
struct Group {
    Mesh mesh;
    std::uint32_t first = 0, count = 0;  ///< objects
};

/// Metres, y up. The ground is at y = 0.
class World {
  public:
    explicit World(std::uint32_t moving);

    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<Group> groups;
    std::vector<glm::vec4> colors;    ///< of every object: linear, and 1 in w where it shines by itself
    std::uint32_t casters = 0;        ///< the first so many objects cast; the lamp's own ball, the last one, does not
    glm::vec3 least_ws, greatest_ws;  ///< corners of a box around everything, whatever moves

    /// Where every object is at a time: ws_from_os.
    void pose(float seconds, std::span<glm::mat4> ws_from_os) const;

    static constexpr glm::vec3 lamp_ws{2.2F, 1.5F, -2.0F};
    static constexpr float lamp_range = 16;  ///< metres
    static constexpr float lamp_radius = 0.16F;
    static glm::vec3 towards_sun();  ///< unit

  private:
    Mesh add_box();
    Mesh add_ball();
    void add_group(const Mesh& mesh, std::uint32_t count);

    std::uint32_t columns_ = 0, balls_ = 0;
};

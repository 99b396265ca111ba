// SPDX-License-Identifier: MIT
// Based on: Kim, Kim, Turk. A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold Casters. JGT 2008. [KKJ08]
// Turns every triangle to the light, and lists what it closes volumes with: an invocation a triangle.
layout(local_size_x = 64) in;
void main() {
    uint t = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    // One instance of each draw; of opaque caps those turned over have the second half of their list.
    if (t == 0u) {
        draws[1] = draws[5] = draws[9] = draws[13] = draws[17] = draws[21] = 1u;
        draws[25] = draws[30] = draws[35] = draws[40] = 1u;
        draws[36] = 3u * u.frame.opaque_triangles;
    }
    if (t >= u.frame.triangles) {
        return;
    }
    // Turn the triangle to the light.
    uint owner = owners[t];
    uvec3 corners = uvec3(indices[3u * t], indices[3u * t + 1u], indices[3u * t + 2u]);
    int m = 0;
    uint form = uint(GN_VOLUMES_NONE);
    if (owner != ~0u) {
        form = forms[owner >> 3];
        int side = gn_volumes_side(positions[corners.x], positions[corners.y], positions[corners.z], u.frame.light_ws);
        side = (owner & 2u) != 0u ? max(side, 0) : side;
        m = gn_volumes_multiplicity(side, int(form & 3u));
    }
    bool before = (form & uint(GN_VOLUMES_BEFORE)) != 0u;
    multiplicity[t] = gn_volumes_packed(m, before);
    if (m == 0) {
        return;
    }
    if ((owner & 1u) == 0u) {
        // List an opaque cap's vertices: no sample is behind it, so where volumes count before samples it need not be seen.
        if (before && (form & uint(GN_VOLUMES_CAPPED)) == 0u) {
            return;
        }
        uint most = 3u * u.frame.opaque_triangles;
        uint slot = atomicAdd(draws[24u + (before ? 5u : 0u) + (m < 0 ? 10u : 0u)], 3u);
        uint first = (m < 0 ? most : 0u) + (before ? most - 3u - slot : slot);
        cap_indices[first] = corners.x;
        cap_indices[first + 1u] = corners.y;
        cap_indices[first + 2u] = corners.z;
        return;
    }
    // What is open and shows the viewer its front lies before no sample.
    bool front_shown = (owner & 7u) == 1u && gn_volumes_side(positions[corners.x], positions[corners.y],
                                                             positions[corners.z], u.frame.eye_ws) > 0;
    if (front_shown && before && (form & uint(GN_VOLUMES_CAPPED)) == 0u) {
        return;
    }
    // List a cap that is compared: those that count behind the sample from the front of the list, the others from its end.
    uint each = gn_volumes_has_far_cap(u.frame) ? 6u : 3u;
    uint slot = atomicAdd(draws[before ? 20 : 16], each) / each;
    caps[before ? u.frame.triangles - 1u - slot : u.frame.opaque_triangles + slot] = t * 2u + (m < 0 ? 1u : 0u);
}

#pragma once

namespace handhold::shaders {

// A ghost's surface over the finished scene, in display space: bright edges and clear faces, like
// thin glass. Used with the mesh vertex shader.
inline constexpr const char* k_ghost_fragment = R"(
in vec3 position_cs;
in vec3 normal_cs;
uniform sampler2D scene_depth;
uniform vec2 depth_terms;  // P22, P32 of the projection
uniform vec3 tint;
uniform float seen;
uniform float hidden;
uniform float hidden_from_m;
uniform float hidden_full_m;
out vec4 color;

float distance_of(float depth) { return depth_terms.y / (2.0 * depth - 1.0 + depth_terms.x); }

void main() {
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    float behind_m = distance_of(gl_FragCoord.z) - distance_of(scene);
    float strength = mix(seen, hidden, smoothstep(hidden_from_m, hidden_full_m, behind_m));
    float facing = abs(dot(normalize(normal_cs), normalize(position_cs)));
    float rim = (1.0 - facing) * (1.0 - facing);
    vec3 rgb = mix(tint * (0.55 + 0.45 * facing), vec3(1.0), 0.55 * rim);
    color = vec4(pow(rgb, vec3(1.0 / 2.2)), min(strength * (0.6 + 0.9 * rim), 1.0));
}
)";

// Writes the depths of visible surfaces only. The scene's depths come from the same vertices but
// are rounded to 24 bits, hence the tolerance.
inline constexpr const char* k_own_depth_fragment = R"(
uniform sampler2D scene_depth;
void main() {
    if (gl_FragCoord.z > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r + 1e-6) discard;
}
)";

}  // namespace handhold::shaders

#pragma once

// The renderer's programs, in the common subset of GLSL 3.30 and GLSL ES 3.00 (the version line is
// added at compilation). All positions are relative to the camera, in the world's axes (suffix
// _cs). Source: shadow maps after Williams 1978 with percentage closer filtering (Reeves et al.
// 1987). Programs that cover the whole picture: picture_shaders.hpp.
namespace handhold::shaders {

inline constexpr const char* k_mesh_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model_to_cs;
uniform mat4 cs_to_clip;
invariant gl_Position;  // the depth pass below must give the same depths
out vec3 position_cs;
out vec3 normal_cs;
out vec3 position_ms;
void main() {
    vec4 p = model_to_cs * vec4(position, 1.0);
    position_cs = p.xyz;
    normal_cs = mat3(model_to_cs) * normal;
    position_ms = position;
    gl_Position = cs_to_clip * p;
}
)";

// In the opaque pass, alpha is the weight of ambient occlusion: 1 for most surfaces, 0 for emissive
// ones.
inline constexpr const char* k_mesh_fragment = R"(
const int k_max_lamps = 12;
in vec3 position_cs;
in vec3 normal_cs;
in vec3 position_ms;
uniform vec3 albedo;
uniform float emissive;
uniform float opacity;
uniform float gloss;
uniform vec3 up;
uniform vec3 sky_ambient;
uniform vec3 ground_ambient;
uniform vec4 lamp_place[k_max_lamps];   // xyz: position_cs, w: 1 / reach squared
uniform vec3 lamp_color[k_max_lamps];
uniform int lamp_count;
uniform vec3 key_towards;
uniform vec3 key_color;
uniform mat4 cs_to_shadow;
uniform float shadow_texel;
uniform float shadow_bias_m;
uniform sampler2DShadow shadow_map;
uniform float head_light;
uniform float exposure;
uniform float haze_per_m;
uniform vec3 haze;
out vec4 color;

float hash(vec3 p) {
    p = fract(p * 0.3183099 + vec3(0.71, 0.113, 0.419));
    p *= 17.0;
    return fract(p.x * p.y * p.z * (p.x + p.y + p.z));
}

// Noise in [-1, 1]: keeps large plain surfaces from looking flat.
float blotches(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    f = f * f * (3.0 - 2.0 * f);
    float low = mix(mix(hash(cell), hash(cell + vec3(1, 0, 0)), f.x),
                    mix(hash(cell + vec3(0, 1, 0)), hash(cell + vec3(1, 1, 0)), f.x), f.y);
    float high = mix(mix(hash(cell + vec3(0, 0, 1)), hash(cell + vec3(1, 0, 1)), f.x),
                     mix(hash(cell + vec3(0, 1, 1)), hash(cell + vec3(1, 1, 1)), f.x), f.y);
    return 2.0 * mix(low, high, f.z) - 1.0;
}

float key_visibility(vec3 n) {
    vec3 at = (cs_to_shadow * vec4(position_cs + n * shadow_bias_m, 1.0)).xyz;
    vec2 from_edge = min(at.xy, 1.0 - at.xy);
    if (min(from_edge.x, from_edge.y) < 0.0 || at.z > 1.0) return 1.0;
    // Nine bilinear taps, one texel apart: a soft edge four texels wide.
    float sum = 0.0;
    for (int i = 0; i < 9; ++i) {
        vec2 offset = vec2(float(i % 3) - 1.0, float(i / 3) - 1.0) * shadow_texel;
        sum += texture(shadow_map, vec3(at.xy + offset, at.z));
    }
    float inside = clamp(min(from_edge.x, from_edge.y) * 12.0, 0.0, 1.0);
    return mix(1.0, sum / 9.0, inside);
}

vec3 shine(vec3 n, vec3 view, vec3 towards) {
    float aligned = max(dot(n, normalize(towards + view)), 0.0);
    return vec3(gloss * (0.35 + 0.7 * gloss) * pow(aligned, 8.0 + 56.0 * gloss));
}

// Filmic curve: dark toe, nearly straight middle, shoulder towards 1.
vec3 tone(vec3 x) { return x * (x + 0.05) / (x * (x + 0.55) + 0.13); }
vec3 to_srgb(vec3 x) {
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThan(x, vec3(0.0031308)));
}

void main() {
    vec3 n = normalize(gl_FrontFacing ? normal_cs : -normal_cs);
    float distance_m = length(position_cs);
    vec3 view = -position_cs / distance_m;
    float height = 0.5 + 0.5 * dot(n, up);
    float rim = pow(1.0 - max(dot(n, view), 0.0), 4.0);
    vec3 ambient = mix(ground_ambient, sky_ambient, height);
    vec3 sum = ambient * (albedo + vec3(0.5 * gloss * rim));
    // Highlights cost a power each, so one highlight serves all lamps, from their mean direction.
    vec3 lamp_light = vec3(0.0);
    vec3 mean_towards = vec3(0.0);
    for (int i = 0; i < lamp_count; ++i) {
        vec3 to_lamp = lamp_place[i].xyz - position_cs;
        float d2 = dot(to_lamp, to_lamp);
        float share = min(d2 * lamp_place[i].w, 1.0);
        float window = 1.0 - share * share;
        float facing = max(dot(n, to_lamp) * inversesqrt(d2 + 1e-6) * 0.8 + 0.2, 0.0);
        float arriving = facing * window * window / (d2 + 0.12);
        lamp_light += arriving * lamp_color[i];
        mean_towards += arriving * to_lamp;
    }
    sum += lamp_light * (albedo + shine(n, view, normalize(mean_towards + 1e-6 * n)));
    float key_facing = max(dot(n, key_towards), 0.0);
    if (key_facing > 0.0) {
        sum += key_color * (key_facing * key_visibility(n)) * (albedo + shine(n, view, key_towards));
    }
    sum += albedo * (head_light * max(dot(n, view), 0.0) / (0.4 + 0.25 * distance_m * distance_m));
    sum *= 1.0 + 0.05 * blotches(position_ms * 4.1);
    sum += albedo * emissive;
    sum = mix(haze, sum, exp(-distance_m * haze_per_m));
    float surface = clamp(1.0 - 0.8 * emissive, 0.0, 1.0);
    color = vec4(to_srgb(tone(sum * exposure)), opacity < 1.0 ? opacity + rim * 0.3 : surface);
}
)";

inline constexpr const char* k_depth_vertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 model_to_cs;
uniform mat4 cs_to_clip;
invariant gl_Position;
void main() {
    vec4 p = model_to_cs * vec4(position, 1.0);
    gl_Position = cs_to_clip * p;
}
)";
inline constexpr const char* k_depth_fragment = "void main() {}\n";

inline constexpr const char* k_line_vertex = R"(
layout(location = 0) in vec4 position;  // clip space
layout(location = 1) in vec3 line_color;
out vec3 tint;
void main() {
    tint = line_color;
    gl_Position = position;
}
)";
inline constexpr const char* k_line_fragment = R"(
in vec3 tint;
uniform float strength;
out vec4 color;
void main() { color = vec4(pow(tint, vec3(1.0 / 2.2)), strength); }
)";

// Panels over the picture. The target is upside down: its lowest row is the picture's top, so y
// needs no flip.
inline constexpr const char* k_ui_vertex = R"(
layout(location = 0) in vec2 place_px;
layout(location = 1) in vec2 glyph_uv;
layout(location = 2) in vec4 rgba;
uniform vec2 size_px;
out vec2 uv;
out vec4 tint;
void main() {
    uv = glyph_uv;
    tint = rgba;
    gl_Position = vec4(2.0 * place_px / size_px - 1.0, 0.0, 1.0);
}
)";
inline constexpr const char* k_ui_fragment = R"(
in vec2 uv;
in vec4 tint;
uniform sampler2D glyphs;
out vec4 color;
void main() { color = tint * texture(glyphs, uv); }
)";

// Panels on a sheet in the world. The target is upside down (its lowest row is the picture's top);
// the scene's depths are upright.
inline constexpr const char* k_sheet_vertex = R"(
layout(location = 0) in vec2 place_px;
layout(location = 1) in vec2 glyph_uv;
layout(location = 2) in vec4 rgba;
uniform vec2 sheet_px;
uniform float m_per_px;
uniform mat4 sheet_to_cs;
uniform mat4 cs_to_clip;
out vec2 uv;
out vec2 at_px;
out vec4 tint;
void main() {
    uv = glyph_uv;
    tint = rgba;
    at_px = place_px;
    vec2 at = (place_px - 0.5 * sheet_px) * m_per_px;
    gl_Position = cs_to_clip * (sheet_to_cs * vec4(at.x, -at.y, 0.0, 1.0));
    gl_Position.y = -gl_Position.y;
}
)";
inline constexpr const char* k_sheet_fragment = R"(
in vec2 uv;
in vec2 at_px;
in vec4 tint;
uniform sampler2D glyphs;
uniform sampler2D scene_depth;
uniform vec4 clip_px;
uniform float target_rows;
uniform int samples_across;
out vec4 color;
void main() {
    if (any(lessThan(at_px, clip_px.xy)) || any(greaterThan(at_px, clip_px.zw))) discard;
    ivec2 pixel = ivec2(gl_FragCoord.x, target_rows - gl_FragCoord.y);
    if (gl_FragCoord.z > texelFetch(scene_depth, pixel * samples_across, 0).r) discard;
    color = tint * texture(glyphs, uv);
}
)";

}  // namespace handhold::shaders

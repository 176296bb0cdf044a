#pragma once

// Shader programs that draw over the whole picture: the backdrop, and the passes after the scene is
// drawn. Language and spaces: shaders.hpp. Sources: ambient obscurance at half resolution after
// McGuire et al. 2011 ("The Alchemy Screen-Space Ambient Obscurance Algorithm"); edge filter after
// Lottes 2009 (FXAA).
namespace handhold::shaders {

// One triangle that covers the picture, at the far plane.
inline constexpr const char* k_screen_vertex = R"(
out vec2 uv;
void main() {
    uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
    gl_Position = vec4(2.0 * uv - 1.0, 1.0, 1.0);
}
)";

inline constexpr const char* k_backdrop_fragment = R"(
in vec2 uv;
uniform vec3 view_right;    // scaled by the half width at distance 1
uniform vec3 view_up;       // scaled by the half height
uniform vec3 view_forward;
uniform vec3 planet;
uniform vec3 sun;
out vec4 color;

float hash(vec3 p) {
    p = fract(p * vec3(0.1031, 0.1030, 0.0973));
    p += dot(p, p.yxz + 33.33);
    return fract((p.x + p.y) * p.z);
}
float noise(vec3 p) {
    vec3 c = floor(p);
    vec3 f = p - c;
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(mix(hash(c), hash(c + vec3(1, 0, 0)), f.x),
                   mix(hash(c + vec3(0, 1, 0)), hash(c + vec3(1, 1, 0)), f.x), f.y),
               mix(mix(hash(c + vec3(0, 0, 1)), hash(c + vec3(1, 0, 1)), f.x),
                   mix(hash(c + vec3(0, 1, 1)), hash(c + vec3(1, 1, 1)), f.x), f.y), f.z);
}
float layers(vec3 p) {
    return 0.5 * noise(p) + 0.25 * noise(2.1 * p) + 0.125 * noise(4.3 * p) + 0.0625 * noise(8.7 * p);
}

vec3 stars(vec3 d) {
    vec3 p = d * 160.0;
    vec3 cell = floor(p);
    float pick = hash(cell);
    vec3 at = cell + 0.25 + 0.5 * vec3(hash(cell + 7.0), hash(cell + 13.0), hash(cell + 29.0));
    float bright = smoothstep(0.30, 0.0, length(p - at)) * smoothstep(0.965, 1.0, pick);
    return bright * mix(vec3(1.0, 0.82, 0.65), vec3(0.75, 0.85, 1.0), hash(cell + 3.0));
}

// The planet is a unit sphere with its centre 1.35 from the eye. Its limb appears 48 degrees from
// its centre.
void main() {
    vec3 d = normalize(view_forward + (2.0 * uv.x - 1.0) * view_right + (2.0 * uv.y - 1.0) * view_up);
    const float k_distance = 1.35;
    float along = dot(d, planet) * k_distance;
    float miss2 = k_distance * k_distance - along * along;
    vec3 sum = stars(d);
    float height = sqrt(max(miss2, 0.0)) - 1.0;
    vec3 rim_normal = normalize(d * along - planet * k_distance);
    float day = smoothstep(-0.25, 0.35, dot(rim_normal, sun));
    if (along > 0.0 && height > 0.0) sum += vec3(0.12, 0.28, 0.62) * exp(-height * 55.0) * day;
    if (along > 0.0 && miss2 < 1.0) {
        vec3 n = d * (along - sqrt(1.0 - miss2)) - planet * k_distance;
        float land = smoothstep(0.47, 0.53, layers(n * 5.0 + 2.0));
        vec3 ground = mix(vec3(0.01, 0.045, 0.13), mix(vec3(0.10, 0.17, 0.06), vec3(0.34, 0.26, 0.15),
                          layers(n * 11.0)), land);
        float cloud = smoothstep(0.45, 0.72, layers(n * vec3(9.0, 16.0, 9.0) + 3.0 * layers(n * 4.0)));
        ground = mix(ground, vec3(0.85), 0.9 * cloud);
        float lit = smoothstep(-0.08, 0.9, dot(n, sun));
        float edge = pow(1.0 - max(dot(n, -d), 0.0), 3.0);
        sum = ground * lit * 0.85 + vec3(0.12, 0.27, 0.60) * (0.05 + 0.8 * edge) * lit;
    }
    color = vec4(pow(sum / (sum + 0.55) * 1.45, vec3(1.0 / 2.2)), 1.0);
}
)";

// Ambient obscurance and distance, computed from the picture's depth.
inline constexpr const char* k_occlusion_fragment = R"(
in vec2 uv;
uniform sampler2D depth_map;
uniform vec2 depth_terms;   // P22, P32 of the projection
uniform vec2 half_extent;   // half size of the picture at distance 1
uniform vec2 middle;        // middle of the picture at distance 1
uniform vec2 texel;         // size of a texel of depth_map
uniform float radius_m;
out vec4 color;

// Position at the centre of the pixel that contains `at`. Between two pixels, rounding would choose
// either one and leave stripes.
vec3 view_at(vec2 at) {
    at = (floor(at / texel) + 0.5) * texel;
    float d = depth_terms.y / (2.0 * texture(depth_map, at).r - 1.0 + depth_terms.x);
    return vec3(((2.0 * at - 1.0) * half_extent + middle) * d, -d);
}
// The step to the neighbour that is nearer in depth, so that the slope does not cross an edge.
vec3 slope(vec3 p, vec2 pixel, vec2 step_uv) {
    vec3 ahead = view_at(pixel + step_uv) - p;
    vec3 behind = p - view_at(pixel - step_uv);
    return abs(ahead.z) < abs(behind.z) ? ahead : behind;
}

void main() {
    vec2 pixel = uv + 0.25 * texel;  // off the seam between four pixels
    vec3 p = view_at(pixel);
    float distance_m = -p.z;
    if (distance_m > 60.0) {
        color = vec4(1.0, 1.0, 0.0, 1.0);
        return;
    }
    vec3 n = normalize(cross(slope(p, pixel, vec2(texel.x, 0.0)), slope(p, pixel, vec2(0.0, texel.y))));
    // Each block of 4 x 4 pixels uses sixteen rotations, each once. The smoothing pass averages
    // over 4 x 4 pixels, so no pattern remains on an even surface.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float turn = 6.2831853 * (float((7 * (4 * cell.y + cell.x)) & 15) + 0.5) / 16.0;
    float reach_uv = clamp(0.5 * radius_m / (distance_m * half_extent.y), 0.006, 0.16);
    float sum = 0.0;
    const int k_taps = 10;
    for (int i = 0; i < k_taps; ++i) {
        float part = (float(i) + 0.5) / float(k_taps);
        float angle = turn + part * 18.849556;
        vec2 offset = vec2(cos(angle), sin(angle)) * part * reach_uv;
        offset.x *= half_extent.y / half_extent.x;
        vec3 v = view_at(pixel + offset) - p;
        float v2 = dot(v, v);
        float fade = max(1.0 - v2 / (radius_m * radius_m * 1.6), 0.0);
        sum += fade * max(dot(v, n) - 0.004 * distance_m, 0.0) / (v2 + 0.0006);
    }
    float open = max(1.0 - radius_m * 1.7 * sum / float(k_taps), 0.0);
    color = vec4(open, distance_m / (distance_m + 2.0), 0.0, 1.0);  // eight bits: more resolution near the camera
}
)";

// Extracts the light of emissive surfaces, at a quarter of the resolution.
inline constexpr const char* k_glow_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;
out vec4 color;
void main() {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 at = uv + texel * vec2((i & 1) == 0 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0);
        vec4 c = texture(picture, at);
        sum += c.rgb * c.rgb * (1.0 - c.a);
    }
    color = vec4(0.25 * sum, 1.0);
}
)";
inline constexpr const char* k_blur_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform vec2 step_uv;
out vec4 color;
void main() {
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = -6; i <= 6; ++i) {
        float weight = exp(-0.5 * float(i * i) / 9.0);
        sum += weight * texture(picture, uv + float(i) * step_uv).rgb;
        total += weight;
    }
    color = vec4(sum / total, 1.0);
}
)";

// Averages the occlusion over 4 x 4 pixels, the period of its noise. Pixels at a different distance
// get little weight.
inline constexpr const char* k_smooth_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;
out vec4 color;
void main() {
    float here = texture(picture, uv).g;
    float sum = 0.0;
    float total = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec2 offset = vec2(float(i & 3) - 1.5, float(i >> 2) - 1.5) * texel;
        vec2 tap = texture(picture, uv + offset).rg;
        float step_up = 20.0 * (tap.g - here);
        float weight = 1.0 / (1.0 + step_up * step_up);
        sum += weight * tap.r;
        total += weight;
    }
    color = vec4(sum / total, here, 0.0, 1.0);
}
)";

// Composes the picture upside down, because rows are read back from the top. If the scene has four
// samples per pixel, the linear filter averages them.
inline constexpr const char* k_composite_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform sampler2D occlusion;
uniform sampler2D glow;
uniform float glow_strength;
out vec4 color;
void main() {
    vec2 at = vec2(uv.x, 1.0 - uv.y);
    vec4 c = texture(picture, at);
    // The picture is already in display space. There, a factor on light becomes its 2.2nd root.
    float open = pow(texture(occlusion, at).r, 0.4545);
    vec3 rgb = c.rgb * mix(1.0, open, c.a);
    rgb = 1.0 - (1.0 - rgb) * (1.0 - glow_strength * texture(glow, at).rgb);
    color = vec4(rgb, dot(rgb, vec3(0.3, 0.6, 0.1)));
}
)";

// Anti-aliasing. Where the brightness (in alpha) changes sharply, averages along the edge, up to
// four pixels in both directions. If this long average is outside the range of the neighbourhood,
// it has crossed another edge. The short average is used instead.
inline constexpr const char* k_edges_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;
out vec4 color;
void main() {
    vec4 here = texture(picture, uv);
    float a = texture(picture, uv + vec2(-0.75, -0.75) * texel).a;
    float b = texture(picture, uv + vec2(0.75, -0.75) * texel).a;
    float c = texture(picture, uv + vec2(-0.75, 0.75) * texel).a;
    float d = texture(picture, uv + vec2(0.75, 0.75) * texel).a;
    float low = min(here.a, min(min(a, b), min(c, d)));
    float high = max(here.a, max(max(a, b), max(c, d)));
    vec2 gradient = vec2(b + d - a - c, c + d - a - b);
    vec2 along = vec2(-gradient.y, gradient.x);
    float min_slope = max(min(abs(along.x), abs(along.y)), 0.03 * (a + b + c + d) + 0.004);
    along = clamp(along / min_slope, -4.0, 4.0) * texel;
    vec4 near = 0.5 * (texture(picture, uv - 0.17 * along) + texture(picture, uv + 0.17 * along));
    vec4 far = 0.5 * (texture(picture, uv - 0.5 * along) + texture(picture, uv + 0.5 * along));
    vec4 wide = 0.5 * (near + far);
    bool is_wide_good = wide.a > low && wide.a < high;
    vec4 smooth_color = is_wide_good ? wide : near;
    color = vec4(high - low < 0.035 ? here.rgb : smooth_color.rgb, 1.0);
}
)";

}  // namespace handhold::shaders

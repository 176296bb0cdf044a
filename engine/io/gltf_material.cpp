#include <algorithm>
#include <array>

#include "engine/io/gltf_json.hpp"

namespace handhold::gltf {
namespace {

constexpr double k_max_emissive = 1e6;  // keeps nearly black colours from giving an infinite factor

// A factor that the specification limits to [0, 1].
float clamp_factor(double value, std::size_t& clamped) {
    clamped += value < 0.0 || value > 1.0 ? 1U : 0U;
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

// Leaves `factors` unchanged if the array is absent.
template <std::size_t Count>
void read_factors(const JsonValue& array, std::array<float, Count>& factors, std::size_t& clamped) {
    const std::vector<double> numbers = read_numbers(array, Count);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        factors[i] = clamp_factor(numbers[i], clamped);
    }
}

}  // namespace

Material parse_material(const JsonValue& value, std::size_t& clamped) {
    Material material;
    std::array<float, 4> base = {1.0F, 1.0F, 1.0F, 1.0F};
    if (const JsonValue pbr = value["pbrMetallicRoughness"]; pbr.exists()) {
        read_factors(pbr["baseColorFactor"], base, clamped);
        material.gloss = 1.0F - clamp_factor(pbr["roughnessFactor"].number_or(1.0), clamped);
    }
    material.color = {base[0], base[1], base[2]};
    if (value["alphaMode"].text_or("OPAQUE") == "BLEND") {
        material.opacity = base[3];
    }
    std::array<float, 3> emissive = {};
    read_factors(value["emissiveFactor"], emissive, clamped);
    double strength = 1.0;
    if (const JsonValue glow = extension_of(value, "KHR_materials_emissive_strength");
        glow.exists()) {
        strength = glow["emissiveStrength"].number_or(1.0);
        clamped += strength < 0.0 ? 1U : 0U;
        strength = std::max(strength, 0.0);
    }
    // Materials here emit light of their own colour. If the file's emissive colour is another one,
    // only its brightness is kept.
    const float brightest = *std::max_element(material.color.begin(), material.color.end());
    if (brightest > 0.0F) {
        const double factor =
            static_cast<double>(*std::max_element(emissive.begin(), emissive.end()));
        material.emissive = static_cast<float>(
            std::min(factor / static_cast<double>(brightest) * strength, k_max_emissive));
    }
    return material;
}

}  // namespace handhold::gltf

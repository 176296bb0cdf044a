#include "engine/io/gltf_primitive.hpp"

#include <algorithm>
#include <utility>

#include "engine/io/gltf.hpp"
#include "engine/io/gltf_draco.hpp"

namespace handhold::gltf {
namespace {

constexpr std::size_t k_max_sets = 4;  // sets of four joints each

// An attribute to read and the destination of its values.
struct Attribute {
    std::string name;
    Elements elements = Elements::vectors;
    std::vector<float>* values = nullptr;
};

// Reads one primitive. Stops at the first error.
class PrimitiveReader {
  public:
    PrimitiveReader(const Primitive& primitive, std::string place, AccessorReader& reader,
                    const Model& model, Refusal& refusal, PrimitiveData& out)
        : primitive_(primitive),
          place_(std::move(place)),
          reader_(reader),
          model_(model),
          refusal_(refusal),
          out_(out) {}

    bool read(const Wanted& wanted) {
        out_ = {};
        out_.mode = *triangle_mode(primitive_);
        return list_attributes(wanted) && read_vertices() && check_indices();
    }

  private:
    bool list_attributes(const Wanted& wanted);
    bool check_fallback();
    bool read_vertices();
    bool read_compressed();
    bool read_accessors();
    bool check_indices();
    std::string place_of(const std::string& attribute) const {
        return place_ + "/attributes/" + attribute;
    }
    int accessor_of(const std::string& attribute) const {
        const auto found = primitive_.attributes.find(attribute);
        return found == primitive_.attributes.end() ? k_none : found->second;
    }

    const Primitive& primitive_;
    std::string place_;
    AccessorReader& reader_;
    const Model& model_;
    Refusal& refusal_;
    PrimitiveData& out_;
    std::vector<Attribute> attributes_;
};

bool PrimitiveReader::list_attributes(const Wanted& wanted) {
    if (wanted.positions) {
        attributes_.push_back({"POSITION", Elements::vectors, &out_.positions});
    }
    if (wanted.normals && primitive_.attributes.contains("NORMAL")) {
        attributes_.push_back({"NORMAL", Elements::vectors, &out_.normals});
    }
    std::size_t sets = wanted.weights ? 1 : 0;
    while (wanted.weights && sets < k_max_sets &&
           (primitive_.attributes.contains("JOINTS_" + std::to_string(sets)) ||
            primitive_.attributes.contains("WEIGHTS_" + std::to_string(sets)))) {
        ++sets;
    }
    out_.joints.resize(sets);  // not resized again: attributes_ points into them
    out_.weights.resize(sets);
    for (std::size_t i = 0; i < sets; ++i) {
        attributes_.push_back({"JOINTS_" + std::to_string(i), Elements::joints, &out_.joints[i]});
        attributes_.push_back(
            {"WEIGHTS_" + std::to_string(i), Elements::weights, &out_.weights[i]});
    }
    for (const Attribute& attribute : attributes_) {
        if (!primitive_.attributes.contains(attribute.name)) {
            return refusal_.refuse(place_of(attribute.name),
                                   "expected this attribute on a skinned mesh");
        }
        if (!reader_.check(accessor_of(attribute.name), attribute.elements,
                           place_of(attribute.name))) {
            return false;
        }
    }
    return true;
}

// Without Draco: checks that the primitive also has uncompressed geometry.
bool PrimitiveReader::check_fallback() {
    const int accessor = accessor_of("POSITION");
    return (has_element(model_.accessors, accessor) &&
            element(model_.accessors, accessor).view != k_none) ||
           refusal_.refuse(place_ + "/extensions/KHR_draco_mesh_compression",
                           "expected a build with Draco, or uncompressed geometry beside it");
}

bool PrimitiveReader::read_vertices() {
    if (!primitive_.draco) {
        return read_accessors();
    }
    return has_draco() ? read_compressed() : check_fallback() && read_accessors();
}

bool PrimitiveReader::read_compressed() {
    const std::string place = place_ + "/extensions/KHR_draco_mesh_compression";
    std::vector<DracoRequest> requests;
    for (const Attribute& attribute : attributes_) {
        const auto found = primitive_.draco->attributes.find(attribute.name);
        if (found == primitive_.draco->attributes.end()) {
            return refusal_.refuse(place + "/attributes/" + attribute.name,
                                   "expected this attribute to be compressed with the others");
        }
        const Accessor& accessor = element(model_.accessors, accessor_of(attribute.name));
        requests.push_back({found->second, components_of(attribute.elements),
                            accessor.is_normalized || attribute.elements == Elements::weights});
    }
    std::string_view bytes;
    if (!reader_.read_view(primitive_.draco->view, place + "/bufferView", bytes)) {
        return false;
    }
    std::optional<DracoGeometry> geometry = decode_draco(bytes, requests, k_max_level_size);
    if (!geometry) {
        return refusal_.refuse(
            place, "expected a mesh of at most " + std::to_string(k_max_level_size) +
                       " vertices and triangles with these attributes, found malformed data");
    }
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
        *attributes_[i].values = std::move(geometry->values[i]);
    }
    out_.mode = TriangleMode::list;  // decoded strips are lists too
    out_.vertices = geometry->vertices;
    out_.indices = std::move(geometry->indices);
    return true;
}

bool PrimitiveReader::read_accessors() {
    const int positions = accessor_of("POSITION");
    if (!reader_.check(positions, Elements::vectors, place_of("POSITION"))) {
        return false;
    }
    const std::uint64_t vertices = element(model_.accessors, positions).count;
    out_.vertices = vertices;
    for (const Attribute& attribute : attributes_) {
        const int accessor = accessor_of(attribute.name);
        if (const std::uint64_t count = element(model_.accessors, accessor).count;
            count != vertices) {
            return refusal_.refuse(place_of(attribute.name),
                                   "expected as many elements as positions, " +
                                       std::to_string(vertices) + ", found " +
                                       std::to_string(count));
        }
        if (!reader_.read_floats(accessor, attribute.elements, place_of(attribute.name),
                                 *attribute.values)) {
            return false;
        }
    }
    if (vertices > k_max_level_size) {
        return refusal_.refuse(place_of("POSITION"),
                               "expected at most " + std::to_string(k_max_level_size) +
                                   " vertices, found " + std::to_string(vertices));
    }
    if (primitive_.indices != k_none) {
        return reader_.read_indices(primitive_.indices, place_ + "/indices", out_.indices);
    }
    out_.indices.resize(vertices);
    for (std::uint32_t i = 0; i < vertices; ++i) {
        out_.indices[i] = i;
    }
    return true;
}

bool PrimitiveReader::check_indices() {
    const auto bad = std::find_if(out_.indices.begin(), out_.indices.end(),
                                  [&](std::uint32_t index) { return index >= out_.vertices; });
    if (bad != out_.indices.end()) {
        return refusal_.refuse(place_ + "/indices", "expected indices below " +
                                                        std::to_string(out_.vertices) + ", found " +
                                                        std::to_string(*bad) + " at " +
                                                        std::to_string(bad - out_.indices.begin()));
    }
    const std::size_t triangles = count_triangles(out_.mode, out_.indices.size());
    if (triangles == 0) {
        return refusal_.refuse(place_, "expected 3 corners a triangle, found " +
                                           std::to_string(out_.indices.size()) + " corners");
    }
    return triangles <= k_max_level_size ||
           refusal_.refuse(place_, "expected at most " + std::to_string(k_max_level_size) +
                                       " triangles, found " + std::to_string(triangles));
}

}  // namespace

std::optional<TriangleMode> triangle_mode(const Primitive& primitive) {
    switch (primitive.mode) {
        case 4:
            return TriangleMode::list;
        case 5:
            return TriangleMode::strip;
        case 6:
            return TriangleMode::fan;
        default:
            return std::nullopt;
    }
}

bool is_skipped(const Primitive& primitive) {
    return !triangle_mode(primitive) || !primitive.attributes.contains("POSITION");
}

bool read_primitive(const Primitive& primitive, const std::string& place, const Wanted& wanted,
                    AccessorReader& reader, const Model& model, Refusal& refusal,
                    PrimitiveData& out) {
    return PrimitiveReader(primitive, place, reader, model, refusal, out).read(wanted);
}

bool find_material(const Primitive& primitive, const std::string& place, const Model& model,
                   Refusal& refusal, const Material*& material) {
    material = nullptr;
    if (primitive.material == k_none) {
        return true;
    }
    if (!has_element(model.materials, primitive.material)) {
        return refusal.refuse_index(place + "/material", "material", model.materials.size(),
                                    primitive.material);
    }
    material = &element(model.materials, primitive.material);
    return true;
}

}  // namespace handhold::gltf

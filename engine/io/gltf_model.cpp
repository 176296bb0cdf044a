#include "engine/io/gltf_model.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "engine/io/glb.hpp"
#include "engine/io/gltf_draco.hpp"
#include "engine/io/gltf_json.hpp"
#include "engine/io/json.hpp"

namespace handhold::gltf {
namespace {

constexpr std::size_t k_shown_name = 60;

constexpr const char* k_draco = "KHR_draco_mesh_compression";
constexpr const char* k_instancing = "EXT_mesh_gpu_instancing";

bool read_synthetic(const JsonValue& object) {
    const JsonValue extras = object["extras"];
    return extras.is_object() && extras["synthetic"].flag_or(false);
}

// Fills a Model. The JSON document keeps the first error.
class ModelParser {
  public:
    explicit ModelParser(const JsonValue& root) : root_(root) {}

    Model parse(std::string_view binary) {
        model_.binary = binary;
        if (const JsonValue version = root_["asset"]["version"];
            version.text().rfind("2.", 0) != 0) {
            version.refuse("version 2.x of glTF");
        }
        parse_extensions();
        parse_data_layout(root_, model_);
        parse_meshes();
        parse_materials();
        parse_nodes();
        parse_skins();
        parse_scenes();
        return std::move(model_);
    }

  private:
    void parse_extensions();
    void parse_meshes();
    void parse_materials();
    void parse_nodes();
    void parse_skins();
    void parse_scenes();

    JsonValue root_;
    Model model_;
};

bool changes_geometry(std::string_view extension) {
    return extension == "KHR_mesh_quantization" || extension == k_meshopt_extension ||
           extension == k_instancing || (extension == k_draco && has_draco());
}

// True if geometry is correct without the extension. The extensions listed here change only
// appearance, lights or metadata.
bool may_be_ignored(std::string_view extension) {
    constexpr std::array<std::string_view, 13> k_families = {"KHR_materials_",
                                                             "KHR_texture_",
                                                             "EXT_texture_",
                                                             "MSFT_texture_",
                                                             "KHR_lights_",
                                                             "EXT_lights_",
                                                             "KHR_xmp",
                                                             "KHR_animation_pointer",
                                                             "EXT_mesh_features",
                                                             "EXT_materials_",
                                                             "EXT_structural_metadata",
                                                             "VRM",
                                                             "ADOBE_materials_"};
    return std::any_of(k_families.begin(), k_families.end(),
                       [&](std::string_view family) { return extension.rfind(family, 0) == 0; });
}

void ModelParser::parse_extensions() {
    std::set<std::string> required;
    for (const JsonValue& extension : root_["extensionsRequired"].optional_items()) {
        const std::string name = extension.text();
        if (!changes_geometry(name) && !may_be_ignored(name)) {
            extension.refuse("a supported extension");
        }
        required.insert(name);
    }
    std::string ignored;
    for (const JsonValue& extension : root_["extensionsUsed"].optional_items()) {
        const std::string name = extension.text();
        if (!changes_geometry(name) && !may_be_ignored(name) && !required.contains(name)) {
            ignored += (ignored.empty() ? "" : ", ") + printable(name, k_shown_name);
        }
    }
    if (!ignored.empty()) {
        model_.notes.push_back("ignored extensions: " + printable(ignored));
    }
}

void ModelParser::parse_meshes() {
    std::size_t morph_targets = 0;
    for (const JsonValue& value : root_["meshes"].optional_items()) {
        Mesh mesh;
        mesh.name = value["name"].label();
        mesh.is_synthetic = read_synthetic(value);
        std::size_t targets_of_mesh = 0;  // all primitives of a mesh have the same number
        for (const JsonValue& item : value["primitives"].items()) {
            Primitive primitive;
            primitive.attributes = read_attributes(item["attributes"]);
            primitive.indices = read_index(item["indices"]);
            primitive.material = read_index(item["material"]);
            primitive.mode =
                item["mode"].exists() ? static_cast<int>(item["mode"].integer(0, 6)) : 4;
            if (const JsonValue draco = extension_of(item, k_draco); draco.exists()) {
                primitive.draco =
                    Draco{static_cast<int>(draco["bufferView"].integer(0, k_max_index)),
                          read_attributes(draco["attributes"])};
            }
            targets_of_mesh = std::max(targets_of_mesh, item["targets"].optional_items().size());
            mesh.primitives.push_back(std::move(primitive));
        }
        morph_targets += targets_of_mesh;
        model_.meshes.push_back(std::move(mesh));
    }
    if (morph_targets > 0) {
        model_.notes.push_back("ignored morph targets: " + std::to_string(morph_targets));
    }
}

void ModelParser::parse_materials() {
    std::size_t clamped = 0;
    for (const JsonValue& value : root_["materials"].optional_items()) {
        model_.materials.push_back(parse_material(value, clamped));
    }
    if (clamped > 0) {
        model_.notes.push_back("material factors clamped to [0, 1]: " + std::to_string(clamped));
    }
}

Affine parse_transform(const JsonValue& node) {
    Affine transform;
    const JsonValue matrix = node["matrix"];
    for (const char* part : {"translation", "rotation", "scale"}) {
        if (matrix.exists() && node[part].exists()) {
            node[part].refuse("either a matrix or translation, rotation and scale");
        }
    }
    if (const std::vector<double> m = read_numbers(matrix, 16); !m.empty()) {  // column-major
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            matrix.refuse("a last row of 0, 0, 0, 1");
        }
        transform.linear << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
        transform.translation = Vec3(m[12], m[13], m[14]);
        return transform;
    }
    const Quat rotation = node["rotation"].rotation_or(Quat::Identity());
    const Vec3 scale = node["scale"].vector_or(Vec3::Ones());
    transform.linear = rotation.toRotationMatrix() * scale.asDiagonal();
    transform.translation = node["translation"].vector_or(Vec3::Zero());
    return transform;
}

// Reads the members that are numbers or arrays of numbers. Members of other types are for other
// programs.
std::map<std::string, std::vector<double>> parse_extras(const JsonValue& extras) {
    constexpr NumberRange k_any = {-std::numeric_limits<double>::max(),
                                   std::numeric_limits<double>::max()};
    std::map<std::string, std::vector<double>> numbers;
    if (!extras.is_object()) {
        return numbers;
    }
    for (const auto& [name, value] : extras.optional_members()) {
        const std::vector<JsonValue> items =
            value.is_array() ? value.items() : std::vector<JsonValue>{value};
        if (std::all_of(items.begin(), items.end(),
                        [](const JsonValue& item) { return item.is_number(); })) {
            std::vector<double>& list = numbers[name];
            for (const JsonValue& item : items) {
                list.push_back(item.number(k_any));
            }
        }
    }
    return numbers;
}

void ModelParser::parse_nodes() {
    for (const JsonValue& value : root_["nodes"].optional_items()) {
        Node node;
        node.name = value["name"].label();
        node.is_synthetic = read_synthetic(value);
        node.mesh = read_index(value["mesh"]);
        node.skin = read_index(value["skin"]);
        node.children = read_index_array(value["children"]);
        node.local = parse_transform(value);
        node.numbers = parse_extras(value["extras"]);
        if (const JsonValue instancing = extension_of(value, k_instancing); instancing.exists()) {
            node.instances = read_attributes(instancing["attributes"]);
        }
        model_.nodes.push_back(std::move(node));
    }
}

void ModelParser::parse_skins() {
    for (const JsonValue& value : root_["skins"].optional_items()) {
        value["joints"].items();  // required
        model_.skins.push_back(
            {read_index_array(value["joints"]), read_index(value["inverseBindMatrices"])});
    }
}

void ModelParser::parse_scenes() {
    model_.scene = read_index(root_["scene"]);
    for (const JsonValue& value : root_["scenes"].optional_items()) {
        model_.scenes.push_back(read_index_array(value["nodes"]));
    }
}

}  // namespace

Result<Model> parse_model(std::string_view bytes, const std::string& file) {
    const Result<GlbChunks> chunks = split_glb(bytes, file);
    if (!chunks) {
        return chunks.error();
    }
    const Result<JsonDocument> document = JsonDocument::parse(chunks.value().json, file);
    if (!document) {
        return document.error();
    }
    Model model = ModelParser(document.value().root()).parse(chunks.value().binary);
    if (document.value().failed()) {
        return document.value().error();
    }
    return model;
}

std::string pointer(const char* section, int index) {
    return std::string("/") + section + "/" + std::to_string(index);
}

bool Refusal::refuse(std::string place, std::string expected) {
    if (!error_) {
        error_ = FileError{file_, std::move(place), std::move(expected)};
    }
    return false;
}

bool Refusal::refuse_index(std::string place, const char* what, std::size_t size, int found) {
    return refuse(std::move(place), std::string("expected a ") + what + " below " +
                                        std::to_string(size) + ", found " + std::to_string(found));
}

}  // namespace handhold::gltf

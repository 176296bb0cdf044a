#include "tools/lab/posed_hands.hpp"

#include <algorithm>

#include "engine/core/text_file.hpp"
#include "engine/io/json.hpp"

namespace handhold::lab {
namespace {

constexpr std::array<std::string_view, 6> k_names = {"thumb", "index",  "middle",
                                                     "ring",  "little", "palm"};

HandCapsule read_capsule(const JsonValue& json) {
    HandCapsule capsule;
    capsule.finger = json["finger"].text();
    if (std::find(k_names.begin(), k_names.end(), capsule.finger) == k_names.end()) {
        json["finger"].refuse("thumb, index, middle, ring, little or palm");
    }
    capsule.link = static_cast<std::uint32_t>(json["link"].integer(0, 1000));
    capsule.a_m = json["a_m"].vector();
    capsule.b_m = json["b_m"].vector();
    capsule.radius_m = json["radius_m"].number(k_positive);
    return capsule;
}

void read_angles(const JsonValue& json, std::array<FingerAngles, k_finger_count>& angles) {
    const std::string name = json["name"].text();
    const auto place =
        static_cast<std::size_t>(std::find(k_names.begin(), k_names.end(), name) - k_names.begin());
    if (place >= k_finger_count) {
        json["name"].refuse("thumb, index, middle, ring or little");
        return;
    }
    std::size_t link = 0;
    for (const JsonValue& curl : json["curl_rad"].items()) {
        if (link < k_max_links) {
            angles[place].curl_rad[link++] = curl.number();
        }
    }
    angles[place].opposition_rad = json["opposition_rad"].number();
}

DrawnHand read_hand(const JsonValue& json) {
    DrawnHand hand;
    hand.id = json["id"].integer(0, INT32_MAX);
    hand.wrist = {json["wrist"]["position_m"].vector(), json["wrist"]["rotation_xyzw"].rotation()};
    for (const JsonValue& capsule : json["capsules"].items()) {
        hand.capsules.push_back(read_capsule(capsule));
    }
    if (json["fingers"].exists()) {
        for (const JsonValue& finger : json["fingers"].items()) {
            read_angles(finger, hand.angles);
        }
    }
    return hand;
}

}  // namespace

Result<std::vector<DrawnHand>> parse_posed_hands(std::string_view text, const std::string& file) {
    std::vector<DrawnHand> hands;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) {
            continue;
        }
        const auto refuse = [&](const FileError& error) {
            return FileError{file, "line " + std::to_string(number) + " " + error.place,
                             error.expected};
        };
        const Result<JsonDocument> document = JsonDocument::parse(line, file);
        if (!document) {
            return refuse(document.error());
        }
        hands.push_back(read_hand(document.value().root()));
        if (document.value().failed()) {
            return refuse(document.value().error());
        }
    }
    return hands;
}

Result<std::vector<DrawnHand>> load_posed_hands(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse_posed_hands(text.value(), path.string());
}

}  // namespace handhold::lab

#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/text_file.hpp"
#include "tools/lab/solve_command.hpp"

// Runs `solve` in a temporary folder. The reader of its files uses only the documented format
// (docs/reference/lab.md).
namespace handhold::lab {

class LabTest : public testing::Test {
  protected:
    LabTest()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  ("handhold_lab_" + std::to_string(getpid()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~LabTest() override { std::filesystem::remove_all(folder_); }

    SolveOptions options(const std::string& scene, int frames = 180) const {
        SolveOptions made;
        made.scene = scene;
        made.frames = frames;
        made.json = folder_ / "out.json";
        return made;
    }
    // The figures of a run that must succeed.
    nlohmann::json solve(const SolveOptions& options) const {
        EXPECT_EQ(solve_command(options), 0) << options.scene;
        return nlohmann::json::parse(text_of(options.json));
    }
    nlohmann::json solve(const std::string& scene, int frames = 180) const {
        return solve(options(scene, frames));
    }
    static std::string text_of(const std::filesystem::path& file) {
        const auto text = read_file(file);
        return text ? text.value() : std::string();
    }

    std::filesystem::path folder_;
};

// One row of F.csv.
struct CsvRow {
    int frame = 0;
    std::string body;
    std::array<double, 13> numbers{};  // x y z qx qy qz qw vx vy vz wx wy wz
};

inline std::vector<CsvRow> parse_rows(const std::string& text) {
    std::vector<CsvRow> rows;
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "frame,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz");
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string cell;
        CsvRow row;
        std::getline(cells, cell, ',');
        row.frame = std::stoi(cell);
        std::getline(cells, row.body, ',');
        for (double& number : row.numbers) {
            EXPECT_TRUE(std::getline(cells, cell, ',')) << line;
            number = std::strtod(cell.c_str(), nullptr);
        }
        rows.push_back(row);
    }
    return rows;
}

}  // namespace handhold::lab

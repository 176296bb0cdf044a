#include "game/play/exit_status.hpp"

#include <cstdio>

namespace handhold {

int refuse(const FileError& error) {
    std::fprintf(stderr, "%s\n", error.message().c_str());
    return k_exit_bad_file;
}

void print_notes(std::span<const std::string> notes) {
    for (const std::string& note : notes) {
        std::fprintf(stderr, "%s\n", note.c_str());
    }
}

}  // namespace handhold

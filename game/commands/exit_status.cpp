#include "game/commands/exit_status.hpp"

#include <cstdio>

namespace handhold {

int refuse(const FileError& error) {
    std::fprintf(stderr, "%s\n", error.message().c_str());
    return k_exit_bad_file;
}

}  // namespace handhold

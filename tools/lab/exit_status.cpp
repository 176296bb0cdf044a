#include "tools/lab/exit_status.hpp"

#include <cstdio>

namespace handhold::lab {

int refuse(const FileError& error) {
    std::fprintf(stderr, "handhold-lab: %s\n", error.message().c_str());
    return k_exit_file;
}

}  // namespace handhold::lab

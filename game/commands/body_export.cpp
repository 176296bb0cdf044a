#include "game/commands/body_export.hpp"

#include "engine/core/text_file.hpp"
#include "game/play/exit_status.hpp"
#include "game/render/robot_body.hpp"

namespace handhold {

int export_body_command(const std::string& file) {
    const auto error = write_file_atomically(file, make_robot_body_glb());
    return error ? refuse(*error) : 0;
}

}  // namespace handhold

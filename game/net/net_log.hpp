#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace handhold {

// Gets each line of a log, without a line break.
using NetLog = std::function<void(const std::string& line)>;
using NetField = std::pair<std::string_view, std::string>;

// "event=joined slot=0 name=ann". Values with other than plain characters are quoted; control
// characters are escaped.
std::string log_line(std::string_view event, std::initializer_list<NetField> fields);

// Writes lines to standard output at once, with the time: "time=2026-11-29T00:15:02Z event=...".
void print_log_line(const std::string& line);

}  // namespace handhold

#pragma once

#include <handhold/handhold.hpp>

namespace handhold {

// Curls of fingers that nobody measures; see hh_finger_curls.
inline constexpr double k_curl_unknown = -1.0;
inline constexpr hh_finger_curls k_curls_unknown{
    {k_curl_unknown, k_curl_unknown, k_curl_unknown, k_curl_unknown, k_curl_unknown}};

}  // namespace handhold

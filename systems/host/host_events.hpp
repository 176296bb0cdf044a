#pragma once

#include <vector>

#include "systems/host/host_world.hpp"

// Parts of finish_events (host_world.hpp): differences between two steps become events.
namespace handhold {

// Keeps the contacts of the step before in `last_contacts`, and gathers those of the last step in
// `contacts`, sorted. Call limit_impulses first.
void gather_contacts(hh_world& host);
// Adds an event of this kind for each of `contacts` that is not among `others`.
void add_contact_events(hh_world& host, hh_event_kind kind,
                        const std::vector<HostContact>& contacts,
                        const std::vector<HostContact>& others);

// Brings the reports of all joints up to date. makes_events: adds events for latches that opened or
// closed, and for joints that came to a limit.
void update_joint_reports(hh_world& host, bool makes_events);

}  // namespace handhold

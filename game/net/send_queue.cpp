#include "game/net/send_queue.hpp"

#include <algorithm>

namespace handhold {

void SendQueue::drop_oldest_newest() {
    const auto found = std::ranges::find(entries_, Delivery::newest, &Entry::delivery);
    bytes_ -= found->bytes.size();
    entries_.erase(found);
    --newest_;
    ++dropped_;
}

bool SendQueue::push(Delivery delivery, std::span<const std::byte> message) {
    const bool is_newest = delivery == Delivery::newest;
    while (newest_ > 0 &&
           ((is_newest && newest_ >= k_most_newest) || bytes_ + message.size() > k_most_bytes)) {
        drop_oldest_newest();
    }
    if (bytes_ + message.size() > k_most_bytes) {
        dropped_ += is_newest ? 1U : 0U;
        return is_newest;
    }
    entries_.push_back({delivery, {message.begin(), message.end()}});
    bytes_ += message.size();
    newest_ += is_newest ? 1U : 0U;
    return true;
}

void SendQueue::pop() {
    bytes_ -= entries_.front().bytes.size();
    newest_ -= entries_.front().delivery == Delivery::newest ? 1U : 0U;
    entries_.pop_front();
}

}  // namespace handhold

// Sets of clients of the crossbar beside a std::set.
#include "pipeline/memory/memory_hub.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <set>

namespace memory_client_set_test {

RC_GTEST_PROP(MemoryClientSet, NextGoesRound, ()) {
    const auto number = rc::gen::inRange<std::uint32_t>(0, pipeline::ClientSet::most);
    const auto members = *rc::gen::nonEmpty(rc::gen::container<std::set<std::uint32_t>>(number));
    pipeline::ClientSet clients;
    clients.add(*number);
    clients.clear();
    for (const std::uint32_t client : members) clients.add(client);
    const std::uint32_t from = *number;
    const auto above = members.lower_bound(from);
    RC_ASSERT(clients.next(from) == (above != members.end() ? *above : *members.begin()));
    RC_ASSERT(clients.has_several() == (members.size() > 1));
}

} // namespace memory_client_set_test

// The messages of a forest: many trees of one recipe, one after the other.
//
// Trees are made as they are sent, so a forest costs one tree's memory.
#ifndef TERRANE_SERVER_ACTOR_FOREST_RUN_H_
#define TERRANE_SERVER_ACTOR_FOREST_RUN_H_

#include <memory>

#include "core/base/violations.h"
#include "server/actor/limits.h"
#include "server/actor/tree_maker.h"

namespace terrane::server {

// What is wrong with the trees of a request. `tree` may be null: then only what
// does not depend on it is checked.
void ValidateForest(const v1::StreamForestRequest& request,
                    const core::Tree* tree, const Limits& limits,
                    core::Violations* violations);

// `request` has no violations.
std::unique_ptr<MessageRun<v1::StreamForestResponse>> MakeForestRun(
    ChosenTree chosen, const v1::StreamForestRequest& request,
    const core::TreeLimits& limits, std::shared_ptr<CostMeter> meter);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_FOREST_RUN_H_

#pragma once

/// What reports say of water, as JSON.

#include <thalweg/pipeline/condition.hpp>
#include <thalweg/terrain/consistency.hpp>

#include <nlohmann/json.hpp>

namespace thalweg {

nlohmann::ordered_json consistency_json(const Consistency& consistency);
nlohmann::ordered_json condition_json(const ConditionReport& report);

}  // namespace thalweg

#pragma once
#include <optional>

#include "runtime/frame/backend.h"

namespace voyager::cuda {

enum class ClockQuery { multiprocessors_khz, memory_khz, memory_bus_bits };

// ask(query): what the driver answers, if it does. Drivers of integrated devices may not tell the
// memory's clock; a rate that is not known is 0.
template <class Ask>
DeviceRates rates_of(unsigned multiprocessors, const Ask& ask) {
  const auto answer = [&](ClockQuery query) {
    return static_cast<double>(std::optional<int>(ask(query)).value_or(0));
  };
  constexpr double kLanes = 128, kHertz = 1e3, kTransfers = 2;  // a clock
  return {kLanes * multiprocessors * kHertz * answer(ClockQuery::multiprocessors_khz),
          kTransfers * kHertz * answer(ClockQuery::memory_khz) *
              answer(ClockQuery::memory_bus_bits) / 8};
}

}  // namespace voyager::cuda

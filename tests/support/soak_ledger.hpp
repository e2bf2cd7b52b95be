#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace gfp::test {

/// What a trial found; `failure` is empty where all is as promised.
struct Trial {
  std::string failure;
  std::map<std::string, double> figures;  ///< Of each, the largest of a block goes into the ledger.

  template <class Number>
  void measured(const std::string& name, Number value) { figures[name] = static_cast<double>(value); }
};

/// Trials in great numbers, by kind, that can be done in parts. The ledger has a line for every block of them:
/// {"kind": "kill", "first": 0, "count": 20, "lost_messages_max": 31, ...}; a run goes on behind the last one and ends at the first failure.
class SoakLedger {
 public:
  explicit SoakLedger(std::string file) : file_(std::move(file)) {}

  /// Trials of this kind until `wanted` are in the ledger; false: one failed, which is told.
  template <class TrialOf>
  bool run(const std::string& kind, std::uint64_t wanted, TrialOf&& trial_of, std::uint64_t block = 20) const {
    for (std::uint64_t first = done(kind); first < wanted; first += block) {
      const std::uint64_t count = std::min(block, wanted - first);
      nlohmann::ordered_json entry = {{"kind", kind}, {"first", first}, {"count", count}};
      std::string failure;
      for (std::uint64_t i = first; i < first + count && failure.empty(); ++i) {
        const Trial trial = trial_of(i);
        if (!trial.failure.empty()) failure = kind + " " + std::to_string(i) + ": " + trial.failure;
        for (const auto& [name, value] : trial.figures) entry[name] = std::max(entry.value(name, value), value);
      }
      if (!failure.empty()) entry["failure"] = failure;
      std::ofstream(file_, std::ios::app) << entry.dump() << std::endl;
      if (!failure.empty()) return std::cerr << failure << "\n", false;
    }
    if (wanted > 0) std::cout << kind << ": " << std::max(wanted, done(kind)) << " as promised\n";
    return true;
  }

 private:
  std::uint64_t done(const std::string& kind) const {
    std::ifstream in(file_);
    std::uint64_t sum = 0;
    for (std::string line; std::getline(in, line);) {
      const auto entry = nlohmann::ordered_json::parse(line, nullptr, false);
      if (entry.is_object() && entry.value("kind", "") == kind && entry.value("failure", "").empty()) sum += entry.value("count", std::uint64_t{0});
    }
    return sum;
  }

  const std::string file_;
};

}  // namespace gfp::test

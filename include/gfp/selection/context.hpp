#pragma once

#include <string>
#include <vector>

#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// What one thing on a table says of another (P4, ALGORITHM 4).
struct ContextOptions {
  double weight = 1.0;         ///< Times the log odds below; 0: every object is judged by itself.
  double together = 0.4;       ///< Log odds of two classes that share a group, beside chance.
  double apart = -0.2;         ///< Of two that are in groups, but share none.
  double size_correlation = 0.1;  ///< Of how much larger than their classes' means two things of one scene are.
  int rounds = 4;              ///< Of mean field.
  std::vector<std::string> groups{  ///< Classes that stand together, separated by blanks; in any number of groups.
      "mug cup bowl plate wine_glass jug spoon knife", "bottle can carton jar box bowl spoon", "pan jar bottle carton spray_bottle plate knife",
      "hammer screwdriver drill clamp spray_bottle box", "toy_car ball shoe", "banana ball bowl plate", "vase wine_glass jug bowl"};
};

template <class Visitor>
void visit_fields(ContextOptions& o, Visitor&& field) {
  field("weight", o.weight, 0.0, 10.0);
  field("together", o.together, -5.0, 5.0);
  field("apart", o.apart, -5.0, 5.0);
  field("size_correlation", o.size_correlation, 0.0, 0.95);
  field("rounds", o.rounds, 1, 50);
  field("groups", o.groups);
}

/// Pairwise log odds of what two objects of one scene are, beside the two being independent; 0 where one is of no class.
class Context {
 public:
  explicit Context(const ContextOptions& options);

  /// Of co-occurrence and relative size: with a, b the standardised deviations of the mean log sizes from their classes' means and r their
  /// correlation, the latter is log N(a, b; r) - log N(a, b; 0).
  double log_odds(const FittedModel& one, const FittedModel& other) const;

 private:
  bool share_a_group(const std::string& one, const std::string& other) const;
  bool in_any_group(const std::string& name) const;

  ContextOptions options_;
  std::vector<std::vector<std::string>> groups_;
};

}  // namespace gfp

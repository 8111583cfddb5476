#pragma once
// What a controller is asked about itself, and in which order.

#include <optional>
#include <string>
#include <vector>

#include "sender/machine/capability_collector.hpp"
#include "sender/machine/words.hpp"

namespace kerf::machine {

/// Gives one question after the other; what is asked next follows from what has been answered.
class Interview {
 public:
  /// Without `enumerate` the lists of codes and settings are left out.
  explicit Interview(bool enumerate) : enumerate_(enumerate) {}

  /// From the beginning. `brief`: only what a reset changes.
  void begin(bool brief);
  /// The answers to these are known already.
  void pass_over(const Words& words);
  /// The next question, which counts as asked from now on; empty when nothing is left to ask.
  [[nodiscard]] std::optional<std::string> next(const CapabilityCollector& known);
  [[nodiscard]] const std::vector<std::string>& asked() const { return asked_; }

 private:
  [[nodiscard]] std::vector<std::string> questions(const CapabilityCollector& known) const;
  void add_enumerations(std::vector<std::string>& list, const CapabilityCollector& known) const;
  [[nodiscard]] bool was_asked(const std::string& question) const;

  bool enumerate_;
  bool brief_ = false;
  /// Answered from what was kept.
  std::vector<std::string> passed_over_;
  std::vector<std::string> asked_;
};

}  // namespace kerf::machine

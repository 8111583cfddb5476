#pragma once
// The same program at another work zero.

#include <string>

#include "rehearsal/line_source.hpp"

namespace kerf::rehearsal {

/// Every G54 to G59 becomes `zero`.
class ZeroRewriter : public LineRewriter {
 public:
  explicit ZeroRewriter(std::string zero) : zero_(std::move(zero)) {}
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override {}

 private:
  std::string zero_;
};

}  // namespace kerf::rehearsal

#pragma once
// A program as the streamer wants it: one line after the other, in wire form.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sender/job/program.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/streaming/line_source.hpp"

namespace kerf::session {

/// Walks through a program once. Lines of which nothing is left for the wire are passed over, and the ProgramFlow says
/// where it waits and ends.
class ProgramLines final : public streaming::LineSource {
 public:
  ProgramLines(std::shared_ptr<const job::Program> program, job::WireForm form, std::shared_ptr<job::ProgramFlow> flow,
               std::uint32_t first_line = 1);
  [[nodiscard]] std::optional<streaming::SourceLine> next() override;
  void move_on() override;

 private:
  void find_next();
  void step();

  std::shared_ptr<const job::Program> program_;
  job::WireForm form_;
  std::shared_ptr<job::ProgramFlow> flow_;
  std::optional<job::ProgramLine> line_;
  bool waits_ = false;
  std::string text_;
};

}  // namespace kerf::session

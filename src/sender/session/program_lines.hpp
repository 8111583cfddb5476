#pragma once
// A program as the streamer wants it: one line after the other, in wire form.

#include <memory>
#include <string>

#include "sender/job/program.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/streaming/line_source.hpp"

namespace kerf::session {

/// Walks through a program once. Lines of which nothing is left for the wire are passed over.
class ProgramLines final : public streaming::LineSource {
 public:
  ProgramLines(std::shared_ptr<const job::Program> program, job::WireForm form);
  [[nodiscard]] std::optional<streaming::SourceLine> next() override;
  void move_on() override;

 private:
  void find_next();

  std::shared_ptr<const job::Program> program_;
  job::WireForm form_;
  std::optional<job::ProgramLine> line_;
  std::string text_;
};

}  // namespace kerf::session

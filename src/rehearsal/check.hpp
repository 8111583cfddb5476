#pragma once
// Reads a program as one machine would, and finds what would go wrong.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "rehearsal/check_machine.hpp"
#include "rehearsal/finding.hpp"
#include "sender/job/program.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::rehearsal {

/// Where a program goes along one axis, in work coordinates of the last zero that it used.
struct AxisExtent {
  std::string axis{};
  double min_mm = 0;
  double max_mm = 0;
  bool operator==(const AxisExtent&) const = default;
};
BOOST_DESCRIBE_STRUCT(AxisExtent, (), (axis, min_mm, max_mm))

struct CheckResult {
  std::uint32_t lines = 0;
  std::uint64_t moves = 0;
  std::uint64_t errors = 0;
  std::uint64_t warnings = 0;
  std::uint64_t notes = 0;
  /// The worst first, then in the order of their first lines.
  std::vector<FindingGroup> groups{};
  std::vector<int> tools{};
  /// Of the axes whose places the program names.
  std::vector<AxisExtent> extents{};

  /// Of the worst group; nothing found is a note.
  [[nodiscard]] Severity worst() const;
};

/// Checks one program. What it keeps in memory does not grow with the program's length.
class Checker {
 public:
  /// `program` must outlive it.
  Checker(const job::Program& program, CheckMachine machine);
  /// The program's switches are set as the job's will be.
  Checker(const job::Program& program, CheckMachine machine, job::WireForm form);
  ~Checker();
  Checker(Checker&&) noexcept;
  Checker& operator=(Checker&&) noexcept;

  /// Reads lines until `most_bytes` more have been read; false when nothing is left to read.
  bool read_on(std::size_t most_bytes);
  /// From 0 to 1.
  [[nodiscard]] double share_read() const;
  /// Once read_on() gave false.
  [[nodiscard]] CheckResult finish();

 private:
  class Reading;
  std::unique_ptr<Reading> reading_;
};

/// All of it at once.
[[nodiscard]] CheckResult check_program(const job::Program& program, const CheckMachine& machine);

}  // namespace kerf::rehearsal

#pragma once
// One callable made of several, for std::visit: `std::visit(Overloaded{[](const Ok&) {…}, [](const auto&) {…}},
// message)`.

namespace kerf::base {

template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <typename... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace kerf::base

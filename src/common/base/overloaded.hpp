#pragma once
// One callable made of several, one for each type that a variant may hold: `std::visit(Overloaded{…, …}, message)`.

namespace kerf::base {

template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <typename... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace kerf::base

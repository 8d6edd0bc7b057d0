#include <string>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>

#include "../hand_written_fields.hpp"
#include "cases.hpp"

using namespace kreisel;
using by_hand::Gyro;
using by_hand::V3;

namespace pruning {

std::vector<Case> gyros() {
  const Gyro start = (Gyro() << 0.02, 0.001, 3, 0.5, 0.01, 500).finished();
  const CardanMoments moments{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4.5e-4}};
  const CardanBearings bearings{{0.5, 1e-3}, {1e3, 2}};
  const RestingFrame<> rest;
  const RotatingFrame<> base{{0.3, -0.2, 0.1}};
  const by_hand::CardanGyro hand{5e-4,   8e-4, 2e-4, 3e-4, 2.5e-4, 4e-4,
                                 0.5e-4, 0.5,  1e-3, 1e3,  2,      base.angular_velocity};
  const auto scene = [&](const auto& guide, const auto& rotor) {
    return form("pruned", start, field(CardanGyro(moments, bearings, guide, rotor)));
  };
  const auto general = [&](const auto& guide, const auto& rotor) {
    return form("general", start, field(CardanGyro(moments, bearings, any_guide(guide), rotor)));
  };
  const auto loose = [&](const std::string& name, const auto& guide, const auto& rotor) {
    return form(name, start, field(CardanGyro(moments, {}, guide, rotor)));
  };
  const auto written = [&](const auto& rates) { return form("by hand", start, rates); };
  return {
      {"Cardan gyro",
       {general(rest, FreeRotor{}), scene(rest, FrictionlessRotor{}),
        written([=](double, const Gyro& y) { return hand.at_rest<false>(y); })}},
      {"Cardan gyro with regulated rotor",
       {general(rest, RegulatedRotor{}), scene(rest, RegulatedRotor{}),
        written([=](double, const Gyro& y) { return hand.at_rest<true>(y); })}},
      {"Cardan gyro on a base that turns",
       {general(base, FreeRotor{}), scene(base, FrictionlessRotor{}),
        written([=](double, const Gyro& y) { return hand.on_base<false>(y); })}},
      {"Cardan gyro with regulated rotor on a base that turns",
       {general(base, RegulatedRotor{}), scene(base, RegulatedRotor{}),
        written([=](double, const Gyro& y) { return hand.on_base<true>(y); })}},
      {"Cardan gyro without springs on a base that turns",
       {loose("general", any_guide(base), FreeRotor{}), loose("pruned", base, FrictionlessRotor{}),
        written([=](double, const Gyro& y) { return hand.on_base<false, false>(y); })}},
  };
}

}  // namespace pruning

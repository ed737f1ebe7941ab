/// Mistakes in the laws beside the paper's snow: cam clay and sand.

#include "tests/mutation/mistakes.h"

namespace neve::test {

std::vector<Mistake> law_mistakes() {
  constexpr const char* cam_clay = "sim/laws/cam_clay.h";
  constexpr const char* sand = "sim/laws/sand.h";
  return {
      {"cam_clay_factor_squared",
       "cam clay: the deviator scaled by 1/r² instead of 1/r",
       {{cam_clay, "out.k = one / square_root_lanes(larger_lanes(r_squared, one));",
         "out.k = one / larger_lanes(r_squared, one);"}}},
      {"cam_clay_softens",
       "cam clay: J_P follows the ratio of volumes the wrong way",
       {{cam_clay, "V J_P = p.J_P * (J * inverse_square_root(found.J_squared_of_history));",
         "V J_P = p.J_P * (inverse_square_root(J_squared) * "
         "square_root_lanes(found.J_squared_of_history));"}}},
      {"cam_clay_mean_kept",
       "cam clay: the mean of b′ kept where its deviator shrinks, so det b′ is not 1",
       {{cam_clay, "add_identity(found.k * d, mean),", "add_identity(found.k * d, t),"}}},
      {"cam_clay_isochoric_packs",
       "cam clay, isochoric: the volume of F_E goes where its history goes",
       {{cam_clay, "out.J_squared = out.keeps_volume ? J_squared : out.J_squared;", ""}}},
      {"cam_clay_isochoric_never_hardens",
       "cam clay, isochoric: J_P follows the volume, so shear hardens and softens nothing",
       {{cam_clay, "V J_P = p.J_P * (J * inverse_square_root(found.J_squared_of_history));",
         "V J_P = p.J_P * (J * inverse_square_root(found.J_squared));"}}},
      {"cam_clay_isochoric_along_the_line",
       "cam clay, isochoric: the deviator scaled by 1/r, to the surface at another pressure",
       {{cam_clay, "out.k = out.keeps_volume ? smaller_lanes(k, one) : out.k;", ""}}},
      {"sand_forgets_volume",
       "sand: pressure before the volume that it gained is given back",
       {{sand, "const V third = Real(1.0 / 3) * gained, t = before + gained,",
         "const V third{}, t = before,"}}},
      {"sand_another_cone",
       "sand: the slope q/p of the cone taken for that of its strains",
       {{sand, "m.cone[l] = row.own[constant_M] * ElementOf<V>(0.81649658092772603 / 3)",
         "m.cone[l] = row.own[constant_M]"}}},
      {"sand_parts_too_late",
       "sand: grains part by the strain of the step alone",
       {{sand, "const MaskOf<V> is_apart = t >= V{}, slides",
         "const MaskOf<V> is_apart = before >= V{}, slides"}}},
  };
}

}  // namespace neve::test

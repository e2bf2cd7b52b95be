#include "gfp/primitive/families.hpp"

#include <cassert>
#include <cmath>

#include "primitive/family_shape.hpp"

namespace gfp {

const std::vector<FamilySpec>& family_specs() {
  constexpr Symmetry kRevolution{.revolution = true, .mirror_x = true, .mirror_y = true};
  constexpr Symmetry kHandled{.mirror_y = true};
  static const std::vector<FamilySpec> specs{
      {.name = "ball", .make = make_ball, .aliases = {"apple", "orange", "sphere", "fruit", "lemon", "peach"}, .symmetry = kRevolution, .upright_share = 0.7},
      {.name = "banana", .make = make_banana, .symmetry = {.flip_z = true}, .upright_share = 0.9},
      {.name = "bottle", .make = make_bottle, .aliases = {"beer_bottle", "wine_bottle", "water_bottle"}, .symmetry = kRevolution, .upright_share = 0.8},
      {.name = "bowl", .make = make_bowl, .aliases = {"dish"}, .symmetry = kRevolution, .hollow = true, .upright_share = 0.9},
      {.name = "box", .make = make_box, .aliases = {"packet", "package", "brick", "book"}, .symmetry = {.cyclic = 2, .mirror_x = true, .mirror_y = true, .flip_z = true}, .upright_share = 0.5},
      {.name = "can", .make = make_can, .aliases = {"tin", "beverage_can", "tube_box"}, .symmetry = {.revolution = true, .mirror_x = true, .mirror_y = true, .flip_z = true}, .upright_share = 0.8},
      {.name = "carton", .make = make_carton, .aliases = {"milk_carton", "tetra_pak"}, .symmetry = {.cyclic = 2, .mirror_x = true, .mirror_y = true}, .upright_share = 0.85},
      {.name = "clamp", .make = make_clamp, .aliases = {"g_clamp", "c_clamp"}, .symmetry = {.flip_z = true}, .upright_share = 0.9},
      {.name = "cup", .make = make_cup, .aliases = {"glass", "tumbler", "beaker", "drinking_glass"}, .symmetry = kRevolution, .hollow = true, .upright_share = 0.8},
      {.name = "drill", .make = make_drill, .aliases = {"power_drill", "cordless_drill"}, .symmetry = kHandled, .upright_share = 0.5},
      {.name = "flat_bottle", .class_name = "bottle", .make = make_flat_bottle, .aliases = {"flask", "detergent_bottle", "mustard_bottle"}, .symmetry = {.cyclic = 2, .mirror_x = true, .mirror_y = true}, .upright_share = 0.8},
      {.name = "hammer", .make = make_hammer, .aliases = {"mallet"}, .symmetry = {.flip_z = true}, .upright_share = 0.95},
      {.name = "jar", .make = make_jar, .aliases = {"jam_jar", "preserving_jar"}, .symmetry = kRevolution, .upright_share = 0.85},
      {.name = "jug", .make = make_jug, .aliases = {"pitcher", "ewer"}, .symmetry = kHandled, .genus = 1, .hollow = true, .upright_share = 0.9},
      {.name = "knife", .make = make_knife, .symmetry = {.mirror_y = true, .flip_z = true}, .upright_share = 0.95},
      {.name = "mug", .make = make_mug, .aliases = {"coffee_mug", "teacup"}, .symmetry = kHandled, .genus = 1, .hollow = true, .upright_share = 0.8},
      {.name = "pan", .make = make_pan, .aliases = {"frying_pan", "saucepan", "skillet", "pot"}, .symmetry = kHandled, .hollow = true, .upright_share = 0.95},
      {.name = "plate", .make = make_plate, .aliases = {"saucer"}, .symmetry = kRevolution, .hollow = true, .upright_share = 0.95},
      {.name = "screwdriver", .make = make_screwdriver, .symmetry = {.mirror_y = true, .flip_z = true}, .upright_share = 0.95},
      {.name = "shoe", .make = make_shoe, .aliases = {"boot", "sneaker", "trainer"}, .symmetry = kHandled, .hollow = true, .upright_share = 0.85},
      {.name = "slipper", .class_name = "shoe", .make = make_slipper, .aliases = {"slide", "sandal", "flip_flop"}, .symmetry = kHandled, .genus = 1, .upright_share = 0.9},
      {.name = "spoon", .make = make_spoon, .aliases = {"ladle"}, .symmetry = kHandled, .upright_share = 0.85},
      {.name = "spray_bottle", .make = make_spray_bottle, .aliases = {"sprayer", "cleanser"}, .symmetry = kHandled, .upright_share = 0.85},
      {.name = "toy_car", .make = make_toy_car, .aliases = {"car", "toy"}, .symmetry = kHandled, .upright_share = 0.9},
      {.name = "vase", .make = make_vase, .aliases = {"flower_vase"}, .symmetry = kRevolution, .hollow = true, .upright_share = 0.9},
      {.name = "wine_glass", .make = make_wine_glass, .aliases = {"goblet", "stemware"}, .symmetry = kRevolution, .hollow = true, .upright_share = 0.9},
  };
  return specs;
}

const FamilySpec* find_family(std::string_view name) {
  for (const auto& spec : family_specs())
    if (spec.name == name) return &spec;
  return nullptr;
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const auto& spec : family_specs()) names.emplace_back(spec.name);
  return names;
}

FamilyInstance sample_family(std::string_view name, Random& random, const SampleFamilyOptions& options) {
  const FamilySpec* spec = find_family(name);
  assert(spec != nullptr);
  ParameterDraw draw(random, options.spread);
  FamilyShape shape = spec->make(draw);
  const int levels = static_cast<int>(std::lround(std::log2(std::clamp(options.resolution, 1.0, 8.0))));
  refine(shape, levels);
  if (options.free_form > 0) bend_freely(shape, options.free_form, random);
  const double base = bounds(shape.mesh.vertices).low.z();
  for (auto& p : shape.mesh.vertices) p.z() -= base;

  FamilyInstance instance;
  instance.class_name = spec->class_name;
  instance.filled_triangles = filled_triangles(shape);
  instance.mesh = std::move(shape.mesh);
  instance.parts = std::move(shape.parts);
  instance.size_m = shape.reference_size_m;
  return instance;
}

}  // namespace gfp

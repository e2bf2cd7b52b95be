#include "wire/primitive_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "gfp/core/random.hpp"
#include "gfp/primitive/content_hash.hpp"
#include "gfp/primitive/families.hpp"
#include "gfp/v1/primitive.pb.h"
#include "wire/bounded_parse.hpp"
#include "app/embedded_primitives.hpp"

namespace gfp::wire {
namespace {

const Primitive& mug() {
  static const Primitive primitive = [] {
    Primitive built = build_family_primitive("mug");
    built.manual_types.assign(built.size(), std::nullopt);
    built.manual_types[3] = PointType::kControl;
    built.manual_types[4] = PointType::kRegular;
    built.content_hash = content_hash(built);
    return built;
  }();
  return primitive;
}

/// Decodes the mug's message after one change.
template <class Change>
ErrorCode error_after(Change&& change) {
  v1::Primitive message;
  EXPECT_TRUE(message.ParseFromString(encode_primitive(mug())));
  change(message);
  const auto primitive = decode_primitive(as_bytes(message.SerializeAsString()));
  EXPECT_FALSE(primitive.has_value());
  return primitive ? ErrorCode::kIo : primitive.error().code;
}

TEST(PrimitiveFile, RoundTripIsExact) {
  const auto back = decode_primitive(as_bytes(encode_primitive(mug())));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(content_hash(*back), mug().content_hash);  // covers every member
  EXPECT_EQ(back->mean, mug().mean);
  EXPECT_EQ(back->modes, mug().modes);
  EXPECT_EQ(back->topology->triangles, mug().topology->triangles);
  EXPECT_EQ(back->topology->filled_triangles, mug().topology->filled_triangles);
  EXPECT_EQ(back->manual_types, mug().manual_types);
  EXPECT_EQ(encode_primitive(*back), encode_primitive(mug()));
}

TEST(PrimitiveFile, RefusesWhatDoesNotFit) {
  const auto corrupt = [](auto&& change) { EXPECT_EQ(error_after(change), ErrorCode::kCorruptData); };
  corrupt([](v1::Primitive& m) { m.mutable_mean()->RemoveLast(); });
  corrupt([](v1::Primitive& m) { m.set_mean(7, std::numeric_limits<double>::quiet_NaN()); });
  corrupt([](v1::Primitive& m) { m.set_mean(7, m.mean(7) + 1e-12); });  // the hash sees it
  corrupt([](v1::Primitive& m) { m.mutable_modes(0)->mutable_displacement()->RemoveLast(); });
  corrupt([](v1::Primitive& m) { m.mutable_modes(1)->set_displacement(0, std::numeric_limits<double>::infinity()); });
  corrupt([](v1::Primitive& m) { m.set_log_size_covariance(0, -1); });
  corrupt([](v1::Primitive& m) { m.mutable_log_size_mean()->Clear(); });
  corrupt([](v1::Primitive& m) { m.set_genus(0); });
  corrupt([](v1::Primitive& m) { m.mutable_stable_poses(0)->set_rotation(0, 2); });
  corrupt([](v1::Primitive& m) { m.mutable_stable_poses(0)->mutable_rotation()->Clear(); });
  corrupt([](v1::Primitive& m) { m.mutable_contact_pairs(0)->set_face(0, 1 << 20); });
  corrupt([](v1::Primitive& m) { m.mutable_contact_pairs(0)->set_face(1, -1); });
  corrupt([](v1::Primitive& m) { m.mutable_contact_pairs(0)->set_barycentric(0, 5); });
  corrupt([](v1::Primitive& m) { m.mutable_contact_pairs(0)->mutable_face()->Clear(); });
  corrupt([](v1::Primitive& m) { (*m.mutable_manual_types())[0] = 9; });
  corrupt([](v1::Primitive& m) { m.mutable_manual_types()->pop_back(); });
  corrupt([](v1::Primitive& m) { m.set_content_hash(1); });
  corrupt([](v1::Primitive& m) { m.mutable_topology()->set_hash(1); });
  corrupt([](v1::Primitive& m) { m.clear_topology(); });
  corrupt([](v1::Primitive& m) { m.mutable_topology()->mutable_triangles()->resize(m.topology().triangles().size() - 12); });  // a hole
  corrupt([](v1::Primitive& m) { m.set_class_name(""); });
  corrupt([](v1::Primitive& m) { m.set_name(""); });
  corrupt([](v1::Primitive& m) { m.mutable_training_views()->add_stable_pose(0); });
  EXPECT_EQ(error_after([](v1::Primitive& m) { m.set_schema_version(2); }), ErrorCode::kUnsupported);
  EXPECT_EQ(error_after([](v1::Primitive& m) { m.mutable_topology()->set_vertex_count(4'000'000'000U); }), ErrorCode::kTooLarge);
  EXPECT_EQ(error_after([](v1::Primitive& m) { for (int i = 0; i < 100; ++i) m.add_modes(); }), ErrorCode::kTooLarge);
}

// Cut or scribbled files give an Error; none gives a primitive, since the hash covers the content.
TEST(PrimitiveFile, RefusesDamagedBytes) {
  const std::string good = encode_primitive(mug());
  for (std::size_t length = 0; length < good.size(); length += good.size() / 97) EXPECT_FALSE(decode_primitive(as_bytes(good.substr(0, length)))) << length;
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    const int at = random.below(static_cast<int>(bad.size()));
    bad[static_cast<std::size_t>(at)] = static_cast<char>(bad[static_cast<std::size_t>(at)] ^ (1 << random.below(8)));
    const auto primitive = decode_primitive(as_bytes(bad));
    if (primitive) {
      EXPECT_EQ(content_hash(*primitive), mug().content_hash) << "byte " << at;  // a bit that carries nothing
    }
  }
}

TEST(PrimitiveFile, FoldersAreReadByName) {
  const auto folder = std::filesystem::temp_directory_path() / "gfp_primitive_folder_test";
  std::filesystem::remove_all(folder);
  EXPECT_EQ(read_primitive_folder(folder).error().code, ErrorCode::kNotFound);
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(write_primitive(folder / "b.gfp", mug()));
  ASSERT_TRUE(write_primitive(folder / "a.gfp", build_family_primitive("can")));
  std::ofstream(folder / "note.txt") << "not a primitive";
  const auto both = read_primitive_folder(folder);
  ASSERT_TRUE(both) << both.error().what;
  ASSERT_EQ(both->size(), 2U);
  EXPECT_EQ((*both)[0].class_name, "can");
  std::ofstream(folder / "c.gfp") << "garbage";
  EXPECT_EQ(read_primitive_folder(folder).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(read_primitive(folder / "absent.gfp").error().code, ErrorCode::kNotFound);
  std::filesystem::remove_all(folder);
}

TEST(EmbeddedPrimitives, AreAllFamilies) {
  const auto primitives = decode_primitives(embedded_primitives());
  ASSERT_TRUE(primitives) << primitives.error().what;
  std::vector<std::string> names;
  for (const auto& primitive : *primitives) names.push_back(primitive.name);
  EXPECT_EQ(names, family_names());
  EXPECT_EQ((*primitives)[0].content_hash, build_family_primitive(names[0]).content_hash);
  for (const auto& primitive : *primitives) EXPECT_FALSE(primitive.training_views.stable_pose.empty()) << primitive.name;
}

}  // namespace
}  // namespace gfp::wire

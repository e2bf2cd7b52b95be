#include "wire/grasp_messages.hpp"

#include <fmt/format.h>

#include "wire/geometry_messages.hpp"

namespace gfp::wire {

void fill(const Grasp& grasp, v1::Grasp& message) {
  fill(grasp.T_camera_tcp, *message.mutable_t_camera_tcp());
  fill(grasp.T_camera_parent, *message.mutable_t_camera_parent());
  fill(grasp.T_camera_pregrasp_tcp, *message.mutable_t_camera_pregrasp_tcp());
  message.set_gripper(grasp.gripper);
  message.set_width_m(grasp.width_m);
  fill(grasp.approach, *message.mutable_approach());
  message.set_epsilon(grasp.epsilon);
  message.set_volume_quality(grasp.volume_quality);
  message.set_force_closure(grasp.force_closure);
  message.set_p_force_closure(grasp.p_force_closure);
  message.set_epsilon_lcb(grasp.epsilon_lcb);
  for (const GraspContact& contact : grasp.contacts) {
    v1::GraspContact& sent = *message.add_contacts();
    fill(contact.point, *sent.mutable_point());
    fill(contact.normal, *sent.mutable_normal());
    sent.set_observed(contact.observed);
  }
  message.set_collision_margin_m(grasp.collision_margin_m);
  message.set_visibility(grasp.visibility);
  message.set_abstain(grasp.abstain);
  message.set_score(grasp.score);
}

Result<Grasp> grasp_from(const v1::Grasp& message) {
  Grasp grasp;
  const auto tcp = transform_from(message.t_camera_tcp(), "grasp.T_camera_tcp");
  if (!tcp) return tl::unexpected(tcp.error());
  const auto parent = transform_from(message.t_camera_parent(), "grasp.T_camera_parent");
  if (!parent) return tl::unexpected(parent.error());
  const auto pregrasp = transform_from(message.t_camera_pregrasp_tcp(), "grasp.T_camera_pregrasp_tcp");
  if (!pregrasp) return tl::unexpected(pregrasp.error());
  if (message.contacts_size() != static_cast<int>(grasp.contacts.size()))
    return failure(ErrorCode::kCorruptData, fmt::format("grasp has {} contacts, expected {}", message.contacts_size(), grasp.contacts.size()));
  grasp.T_camera_tcp = *tcp;
  grasp.T_camera_parent = *parent;
  grasp.T_camera_pregrasp_tcp = *pregrasp;
  grasp.gripper = message.gripper();
  grasp.width_m = message.width_m();
  grasp.approach = vector_from(message.approach());
  grasp.epsilon = message.epsilon();
  grasp.volume_quality = message.volume_quality();
  grasp.force_closure = message.force_closure();
  grasp.p_force_closure = message.p_force_closure();
  grasp.epsilon_lcb = message.epsilon_lcb();
  for (int i = 0; i < message.contacts_size(); ++i) {
    const v1::GraspContact& sent = message.contacts(i);
    grasp.contacts[static_cast<std::size_t>(i)] = {vector_from(sent.point()), vector_from(sent.normal()), sent.observed()};
  }
  grasp.collision_margin_m = message.collision_margin_m();
  grasp.visibility = message.visibility();
  grasp.abstain = message.abstain();
  grasp.score = message.score();
  return grasp;
}

}  // namespace gfp::wire

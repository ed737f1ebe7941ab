#include <algorithm>
#include <numeric>

#include "render/light/shading_constants.h"
#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {
namespace {

struct MeshVertex {
  Vec3f position, normal;
};

/// Returns vertices relative to the eye. Without normals the shader takes those of the faces.
std::vector<MeshVertex> vertices_of(const TriangleMesh& mesh, Vec3f eye) {
  std::vector<MeshVertex> vertices(mesh.position.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] = {mesh.position[i] - eye, mesh.normal.empty() ? Vec3f{} : mesh.normal[i]};
  return vertices;
}

float distance_to(const TriangleMesh& mesh, Vec3f eye) {
  Vec3f sum;
  for (const Vec3f& p : mesh.position) sum = sum + p;
  return length(sum / static_cast<float>(std::max<std::size_t>(mesh.position.size(), 1)) - eye);
}

/// Order for blending: nearer meshes are drawn over farther ones.
std::vector<std::size_t> far_to_near(const std::vector<TriangleMesh>& meshes, Vec3f eye) {
  std::vector<float> distance;
  for (const TriangleMesh& mesh : meshes) distance.push_back(distance_to(mesh, eye));
  std::vector<std::size_t> order(meshes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance[a] > distance[b]; });
  return order;
}

}  // namespace

void set_blended_state(const gl::Gl& gl) {
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_FALSE);
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_SCISSOR_TEST);
}

MeshPass::MeshPass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "mesh.vert", "mesh.frag"),
      ghost_program_(gl, library, "mesh.vert", "ghost.frag"),
      vertex_array_(gl),
      vertex_buffer_(gl),
      index_buffer_(gl) {
  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.id());
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), nullptr);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex),
                         reinterpret_cast<const void*>(offsetof(MeshVertex, normal)));
  gl.EnableVertexAttribArray(0);
  gl.EnableVertexAttribArray(1);
}

void MeshPass::draw(const std::vector<TriangleMesh>& meshes, const View& view) {
  if (meshes.empty()) return;
  gl::set_solid_state(gl_);
  program_.use();
  set_view(program_, view);
  for (const TriangleMesh& mesh : meshes) {
    program_.set("kind",
                 static_cast<float>(mesh.is_holdout ? light::kind_holdout : light::kind_solid));
    draw_mesh(program_, mesh, view);
  }
}

void MeshPass::draw_ghosts(const std::vector<TriangleMesh>& meshes, Vec3f toward_light,
                           const View& view) {
  if (meshes.empty()) return;
  set_blended_state(gl_);
  ghost_program_.use();
  set_view(ghost_program_, view);
  ghost_program_.set("toward_light", toward_light);
  for (const std::size_t k : far_to_near(meshes, view.eye)) {
    // The far side shines through the near one.
    for (const int is_far_side : {1, 0}) {
      ghost_program_.set("is_far_side", is_far_side);
      draw_mesh(ghost_program_, meshes[k], view);
    }
  }
}

void MeshPass::draw_mesh(const gl::Program& program, const TriangleMesh& mesh, const View& view) {
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
  const std::vector<MeshVertex> vertices = vertices_of(mesh, view.eye);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(MeshVertex)),
                 vertices.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.index.size() * sizeof(std::uint32_t)),
                 mesh.index.data(), GL_STREAM_DRAW);
  program.set("color", mesh.color);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.index.size()), GL_UNSIGNED_INT, nullptr);
}

}  // namespace neve::render::passes

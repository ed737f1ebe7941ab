#include "render/passes.h"

namespace neve::render {
namespace {

struct MeshVertex {
  Vec3f position, normal;
};

/// Relative to the eye. Without normals they stay zero and the shader takes those of the faces.
std::vector<MeshVertex> vertices_of(const TriangleMesh& mesh, Vec3f eye) {
  std::vector<MeshVertex> vertices(mesh.position.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] = {mesh.position[i] - eye, mesh.normal.empty() ? Vec3f{} : mesh.normal[i]};
  return vertices;
}

}  // namespace

MeshPass::MeshPass(const Gl& gl, const ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "mesh.vert", "mesh.frag"),
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
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_SCISSOR_TEST);
  program_.use();
  set_view(program_, view);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
  for (const TriangleMesh& mesh : meshes) {
    const std::vector<MeshVertex> vertices = vertices_of(mesh, view.eye);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(MeshVertex)),
                   vertices.data(), GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(mesh.index.size() * sizeof(std::uint32_t)),
                   mesh.index.data(), GL_STREAM_DRAW);
    program_.set("color", mesh.color);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.index.size()), GL_UNSIGNED_INT,
                     nullptr);
  }
}

}  // namespace neve::render

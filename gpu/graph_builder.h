// SPDX-License-Identifier: MIT
// What a pass's setup lambda writes into: ports, checked as they are declared.
#pragma once

#include "gpu/graph_plan.h"

namespace gn {

class DeclaredPassBuilder final : public PassBuilder {
  public:
    DeclaredPassBuilder(const GraphDeclaration& declaration, DeclaredPass& pass)
        : declaration_(declaration), pass_(pass) {}

    void color(TextureHandle target, Load load, ClearValue clear, Range range) override;
    void depth(TextureHandle target, Load load, ClearValue clear, Range range) override;
    void depth_read_only(TextureHandle target, Range range, std::optional<std::uint32_t> clear_stencil) override;
    void sample(TextureHandle texture, Range range) override;
    void storage_read(TextureHandle texture, Range range) override;
    void storage_write(TextureHandle texture, Range range) override;
    void storage_read(BufferHandle buffer) override;
    void storage_write(BufferHandle buffer) override;
    void vertices(BufferHandle buffer) override;
    void indices(BufferHandle buffer) override;
    void indirect(BufferHandle buffer) override;
    void copy_from(TextureHandle texture, Range range) override;
    void copy_to(TextureHandle texture, Range range) override;
    void copy_from(BufferHandle buffer) override;
    void copy_to(BufferHandle buffer) override;
    void keep() override { pass_.keep = true; }

  private:
    void add(UseKind kind, TextureHandle texture, Range range, Use use = {});
    void add(UseKind kind, BufferHandle buffer);
    void check_attachment(const Use& use) const;

    const GraphDeclaration& declaration_;
    DeclaredPass& pass_;
};

}  // namespace gn

# SPDX-License-Identifier: MIT
# Neighbours compile as one, eight sources at a time: reading precompiled headers and instantiating what their inline
# functions use costs three times what most sources cost themselves. Names in unnamed namespaces are therefore unique within
# eight neighbours. Parts and tests, which all call their functions alike, stand in namespaces of their own for that.
# Without the option, as in the debug build, every source compiles alone and must include what it uses.
option(GNOMON_TOGETHER "Compile eight sources as one" ON)

function(gn_together target)
  if(GNOMON_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# The walks of lab/walks, one variant of a shader each; those with keys or trails in two widths.
set(variants)
foreach(shader tree_walk scene_walk)
  foreach(walk stack parent_link skip_link)
    string(TOUPPER ${walk} macro)
    list(APPEND variants ${shader}_${walk}:${shader}:WALK_${macro})
  endforeach()
  foreach(walk restart_trail trail pair_trail)
    string(TOUPPER ${walk} macro)
    list(APPEND variants ${shader}_${walk}_32:${shader}:WALK_${macro},Key=uint
                         ${shader}_${walk}_64:${shader}:WALK_${macro},Key=HeapKey)
  endforeach()
  list(APPEND variants ${shader}_restart:${shader}:WALK_KD,kIsPushDown=false,kIsBacktrack=false
                       ${shader}_push_down:${shader}:WALK_KD,kIsPushDown=true,kIsBacktrack=false
                       ${shader}_backtrack:${shader}:WALK_KD,kIsPushDown=false,kIsBacktrack=true)
endforeach()
set(scene_walks ${variants})
list(FILTER scene_walks INCLUDE REGEX ^scene_walk)
list(TRANSFORM scene_walks REPLACE ":.*" "")
relief_shaders(relief_lab ${CMAKE_CURRENT_LIST_DIR} lab/vulkan/lab_shaders.h relief::vulkan::lab
               VARIANTS ${variants} FULL_SCREEN ${scene_walks})

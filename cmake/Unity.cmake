# Several files of a library in one translation unit. The libraries of the time step stay as they are: their files are few
# and long, and their code is to be the same with and without this.
set(program mpmfast)
if(TARGET mpmfast_program)
  set(program mpmfast_program)
endif()
set_target_properties(mpmfast_quantities mpmfast_geometry mpmfast_scene mpmfast_output mpmfast_core mpmfast_study
  mpmfast_report ${program} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)

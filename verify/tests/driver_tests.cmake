# Tests of driver/, included by the CMakeLists.txt beside this file.
foreach(name driver_scene_file_test driver_schedule_test)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE bounce_driver GTest::gtest_main)
  gtest_discover_tests(${name} PROPERTIES LABELS driver)
endforeach()

foreach(name driver_run_test driver_stability_test)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  target_compile_definitions(${name} PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
  target_link_libraries(${name} PRIVATE bounce_options GTest::gtest_main)
  add_dependencies(${name} bounce)
  gtest_discover_tests(${name} PROPERTIES LABELS driver TIMEOUT 120)
endforeach()

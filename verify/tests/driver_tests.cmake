# Tests of driver/, included by the CMakeLists.txt beside this file.
foreach(name driver_scene_file_test driver_schedule_test driver_trouble_test)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE bounce_driver GTest::gtest_main)
  gtest_discover_tests(${name} PROPERTIES LABELS driver)
endforeach()

add_executable(driver_extremes_test ${CMAKE_CURRENT_LIST_DIR}/driver_extremes_test.cpp)
target_compile_definitions(driver_extremes_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_extremes_test PRIVATE bounce_driver GTest::gtest_main)
add_dependencies(driver_extremes_test bounce)
gtest_discover_tests(driver_extremes_test PROPERTIES LABELS driver TIMEOUT 600)

add_executable(driver_run_test ${CMAKE_CURRENT_LIST_DIR}/driver_run_test.cpp)
target_compile_definitions(driver_run_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_run_test PRIVATE bounce_options GTest::gtest_main)
add_dependencies(driver_run_test bounce)
gtest_discover_tests(driver_run_test PROPERTIES LABELS driver TIMEOUT 120)

# Tests of driver/, included by the CMakeLists.txt beside this file.
add_executable(driver_scene_file_test ${CMAKE_CURRENT_LIST_DIR}/driver_scene_file_test.cpp)
target_link_libraries(driver_scene_file_test PRIVATE bounce_driver GTest::gtest_main)
gtest_discover_tests(driver_scene_file_test PROPERTIES LABELS driver)

add_executable(driver_run_test ${CMAKE_CURRENT_LIST_DIR}/driver_run_test.cpp)
target_compile_definitions(driver_run_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_run_test PRIVATE bounce_options GTest::gtest_main)
add_dependencies(driver_run_test bounce)
gtest_discover_tests(driver_run_test PROPERTIES LABELS driver TIMEOUT 120)

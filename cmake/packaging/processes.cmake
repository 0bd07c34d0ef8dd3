# The package posewright-mpi: the module that lets several processes share the work of one command.
posewright_package(posewright-mpi mpi SECTION science
  DEPENDS "posewright (= ${PROJECT_VERSION}-${debian_revision}), openmpi-bin"
  SUMMARY "several processes for one command of posewright"
  TEXT "The module that posewright loads where mpirun or srun start several of it:
virtual experiments, places of instruments, plans of a fleet and searches are
shared among them, with the same result.")

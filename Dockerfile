# The image holds the Debian packages of the program and of the Python package, and nothing that was needed to make them.
FROM debian:12-slim AS build
WORKDIR /source
COPY . .
RUN scripts/setup package \
 && cmake --preset release -DPOSEWRIGHT_BUILD_TESTS=OFF -DPOSEWRIGHT_BUILD_PYTHON=ON \
 && cmake --build --preset release \
 && scripts/apt-repository /packages

FROM debian:12-slim
COPY --from=build /packages /packages
RUN echo 'deb [trusted=yes] file:/packages ./' > /etc/apt/sources.list.d/posewright.list \
 && apt-get update \
 && apt-get install -y --no-install-recommends posewright python3-posewright \
 && rm -rf /var/lib/apt/lists/* /packages /etc/apt/sources.list.d/posewright.list \
 && useradd --create-home planner
USER planner
WORKDIR /home/planner
ENTRYPOINT ["posewright"]
CMD ["--help"]

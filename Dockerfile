# Built by the scripts of the README; the image holds the Debian package and nothing that was needed to make it.
FROM debian:12-slim AS build
WORKDIR /source
COPY . .
RUN scripts/plan-telescope \
 && apt-get install -y --no-install-recommends dpkg-dev file \
 && cmake --build --preset release \
 && cd build/release && cpack -G DEB -B /package

FROM debian:12-slim
COPY --from=build /package/posewright_*.deb /tmp/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /tmp/posewright_*.deb \
 && rm -rf /var/lib/apt/lists/* /tmp/posewright_*.deb \
 && useradd --create-home planner
USER planner
WORKDIR /home/planner
ENTRYPOINT ["posewright"]
CMD ["--help"]

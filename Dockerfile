# The README's two commands on a clean machine: docker build -t iiwa_dnn . && docker run --rm iiwa_dnn make heart
# Written beside .ci/run, whose packages these are; it was never built where this was made.
FROM python:3.12-slim-bookworm
RUN apt-get update -q && apt-get install -q -y --no-install-recommends \
    chromium chromium-driver clang g++ gcc git libegl1 libgl1 libgomp1 libosmesa6 make \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /iiwa_dnn
COPY . .
RUN make setup
CMD ["make", "test"]

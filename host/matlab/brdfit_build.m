function brdfit_build(library)
% BRDFIT_BUILD  Compiles the MEX from the static library of this folder.
%
%   brdfit_build                                % target/release/libbrdfit_matlab.a of the repository
%   brdfit_build('somewhere/libbrdfit_matlab.a')
%
%   First: cargo build --release -p brdfit-matlab

    here = fileparts(mfilename('fullpath'));
    root = fullfile(here, '..', '..');
    if nargin < 1
        library = fullfile(root, 'target', 'release', 'libbrdfit_matlab.a');
    end
    if ~exist(library, 'file')
        error('brdfit:noLibrary', 'brdfit_build: %s is not there: cargo build --release -p brdfit-matlab', library);
    end
    source = fullfile(here, 'private', 'brdfit_mex.c');
    include = ['-I' fullfile(root, 'core', 'capi', 'include')];
    if exist('OCTAVE_VERSION', 'builtin')
        mkoctfile('--mex', include, '-Wall', '-Wextra', '-o', fullfile(here, 'private', ['brdfit_mex.' mexext()]), source, library, '-lpthread', '-ldl', '-lm');
    else
        mex(include, '-outdir', fullfile(here, 'private'), source, library);
    end
end

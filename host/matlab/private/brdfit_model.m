function number = brdfit_model(name)
% BRDFIT_MODEL  Number of a model of the C interface from its name.
    names = {'beckmann', 'ggx'};
    if ~ischar(name) || ~any(strcmp(name, names))
        error('brdfit:badModel', 'brdfit: the model must be one of %s; brdfit_program has more', strjoin(names, ', '));
    end
    number = find(strcmp(name, names)) - 1;
end

!> What the point mode is told to do.
module point_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use loading_path, only : path
    use unit_names, only : units
    implicit none
    private

    public :: point_run

    type :: point_run
        real(dp), allocatable :: props(:)   !! constants of the friction routine
        type(path) :: loading
        logical :: tangent = .false.        !! the CSV file shows the tangent
        type(units) :: units                !! that the numbers are in, for pictures
    end type point_run

end module point_settings
